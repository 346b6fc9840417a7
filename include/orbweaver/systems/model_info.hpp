#pragma once

#include <string>
#include <vector>

namespace orbweaver::systems {

/// A named real parameter of a system and the values it may take.
struct Parameter {
  std::string name;
  double standard = 0.0;    ///< value when the scene does not give one
  double lower = 0.0;       ///< least allowed value
  double upper = 0.0;       ///< greatest allowed value
  bool lower_open = false;  ///< true: `lower` itself is refused (a mass must be > 0)
  std::string unit;         ///< "kg", "m", "1"
  std::string meaning;      ///< one phrase
};

/// Something a scene may add to the ideal system (friction, a drive, ...), with the parameters it brings.
struct Effect {
  std::string name;
  std::string meaning;  ///< its terms in words, one phrase
  std::vector<Parameter> parameters;
};

/// What may be asked of a model, before anything is bound. What then holds is its Structure.
struct ModelInfo {
  std::string name;                        ///< as in a scene: "double_pendulum"
  std::string title;                       ///< as a person would write it
  std::string meaning;                     ///< what moves under what, in one phrase
  std::vector<std::string> state_names;    ///< one a coordinate
  std::vector<std::string> winding_names;  ///< one a coordinate: of its winding number; "" where it is never an angle
  std::vector<Parameter> parameters;
  std::vector<Effect> effects;
};

}  // namespace orbweaver::systems
