#include "test_functions/rules.hpp"

#include "orbweaver/core/error.hpp"
#include "test_functions/in_sector.hpp"
#include "test_functions/krein.hpp"
#include "test_functions/torus.hpp"

namespace orbweaver::bifurcation {

namespace {

template <class Kind>
const Rule& the() {
  static const Kind rule;
  return rule;
}

}  // namespace

const Rule& rule_of(TestFunction::Kind kind) {
  switch (kind) {
    case TestFunction::Kind::sector: return the<InSector>();
    case TestFunction::Kind::krein: return the<Krein>();
    case TestFunction::Kind::torus: return the<Torus>();
  }
  throw core::MisuseError("a kind of test function that is none");
}

}  // namespace orbweaver::bifurcation
