#pragma once

#include "orbweaver/document/document.hpp"
#include "orbweaver/document/field.hpp"
#include "orbweaver/document/source.hpp"
#include "orbweaver/document/suggest.hpp"
#include "orbweaver/document/units.hpp"
#include "orbweaver/scene/known_keys.hpp"

/// What the readers of a scene's sections read with.
namespace orbweaver::scene {

using document::alternatives;
using document::degrees;
using document::Field;
using document::IntegerRule;
using document::Keys;
using document::longest_path;
using document::longest_scene;
using document::most_levels;
using document::nearest;
using document::NumberRule;
using document::Override;
using document::parse_angle;
using document::parse_document;
using document::parse_integer;
using document::parse_number;
using document::quoted;
using document::radians;
using document::require_scene_size;
using document::require_text;
using document::Source;

}  // namespace orbweaver::scene
