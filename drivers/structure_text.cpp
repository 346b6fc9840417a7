#include "structure_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace orbweaver::drivers {

namespace {

/// One coordinate of a map's image: "-th1", "phase + 180 deg", "-0.5 x - 0.866025 y", "-x + 2".
std::string image_text(const std::vector<std::string>& coordinates, const systems::AffineMap& map, Eigen::Index row,
                       bool is_angle) {
  std::string text;
  const auto add = [&](double factor, const std::string& of) {
    const double size = std::abs(factor);
    const std::string sign = factor < 0.0 ? (text.empty() ? "-" : " - ") : (text.empty() ? "" : " + ");
    text += sign + (size == 1.0 ? of : fmt::format("{:.6g} {}", size, of));
  };
  for (Eigen::Index l = 0; l < map.matrix.cols(); ++l)
    if (map.matrix(row, l) != 0.0) add(map.matrix(row, l), coordinates[static_cast<std::size_t>(l)]);
  if (const double offset = map.offset(row); offset != 0.0) {
    if (is_angle)
      add(offset / std::numbers::pi * 180.0, "deg");
    else
      text += fmt::format("{}{:.6g}", offset < 0.0 ? (text.empty() ? "-" : " - ") : (text.empty() ? "" : " + "),
                          std::abs(offset));
  }
  return text.empty() ? "0" : text;
}

}  // namespace

std::string symmetries_text(const std::vector<std::string>& coordinates, const std::vector<int>& angles,
                            const std::vector<systems::Symmetry>& symmetries) {
  std::vector<std::string> texts;
  for (const systems::Symmetry& symmetry : symmetries) {
    std::vector<std::string> images;
    for (Eigen::Index row = 0; row < symmetry.map.dimension(); ++row)
      images.push_back(image_text(coordinates, symmetry.map, row,
                                  std::find(angles.begin(), angles.end(), static_cast<int>(row)) != angles.end()));
    texts.push_back(fmt::format("{}: {}", symmetry.name, fmt::join(images, ", ")));
  }
  return texts.empty() ? "none" : fmt::format("of ({}): {}", fmt::join(coordinates, ", "), fmt::join(texts, "; "));
}

std::string family_kind_text(const systems::Structure& structure) {
  switch (structure.family_kind()) {
    case systems::FamilyKind::none: return "none: damped and without a drive, all motions come to rest";
    case systems::FamilyKind::conservative:
      return "conservative: the period and the conserved quantity move along a family";
    case systems::FamilyKind::dissipative: return "dissipative: the period and one parameter move along a family";
    case systems::FamilyKind::driven_damped:
      return "driven, damped: one parameter moves along a family, and periods are multiples of the drive's";
    case systems::FamilyKind::driven_undamped:
      return "driven, undamped: one parameter moves along a family, periods are multiples of the drive's, and "
             "multipliers come in pairs";
  }
  return "";
}

std::vector<std::pair<std::string, std::string>> structure_lines(const systems::ModelInfo& info,
                                                                 const systems::Structure& structure,
                                                                 const std::string& families) {
  const auto& conserved = structure.conserved;
  return {{"conserved", conserved.empty() ? "nothing" : fmt::format("{}", fmt::join(conserved, ", "))},
          {"symmetries", symmetries_text(info.state_names, structure.angles, structure.equivariances)},
          {"reversors", symmetries_text(info.state_names, structure.angles, structure.reversors)},
          {"families", families}};
}

std::string parameter_text(const systems::Parameter& parameter, double value) {
  return fmt::format("{} = {}{}{}", parameter.name, value, parameter.unit == "1" ? "" : " " + parameter.unit,
                     parameter.meaning.empty() ? "" : fmt::format(" ({})", parameter.meaning));
}

}  // namespace orbweaver::drivers
