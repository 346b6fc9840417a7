#include "auto_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/posix_file.hpp"
#include "orbweaver/core/process.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/systems/fortran.hpp"

namespace orbweaver::cost {

namespace {

/// AUTO's step along the family, in parts of the change of the orbit with its period: little but a correction.
constexpr double step = 1e-6;
constexpr double least_tolerance = 1e-12;  // Newton's method reaches no less

std::filesystem::path auto_folder() {
  const char* given = std::getenv("AUTO_DIR");
  return given != nullptr ? given : "/usr/lib/auto-07p";
}

constexpr const char* subroutines = R"(
SUBROUTINE STPNT(NDIM,U,PAR,T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  INTEGER, SAVE :: n=0
  DOUBLE PRECISION, SAVE :: period
  DOUBLE PRECISION, ALLOCATABLE, SAVE :: states(:,:)
  INTEGER j
  IF(n==0)THEN
     OPEN(47,FILE='guess.dat',STATUS='OLD')
     READ(47,*)n,period
     ALLOCATE(states(NDIM,0:n))
     DO j=0,n
        READ(47,*)states(:,j)
     ENDDO
     CLOSE(47)
  ENDIF
  PAR(1)=0; PAR(3)=period; PAR(11)=period
  U=states(:,NINT(T*n))
END SUBROUTINE STPNT

SUBROUTINE PVLS(NDIM,U,PAR)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM,0:*)
  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)
  DOUBLE PRECISION, EXTERNAL :: GETP
  DOUBLE PRECISION t
  INTEGER i,n,c
  IF(PAR(11)==PAR(3))RETURN ! the guess itself
  n=NINT(GETP('NTST',0,U)); c=NINT(GETP('NCOL',0,U))
  OPEN(48,FILE='found.dat')
  WRITE(48,'(I8,ES25.16)')n,PAR(11)
  t=0
  DO i=0,n-1
     WRITE(48,'(99ES25.16)')t,U(:,i*c)
     t=t+GETP('DTM',i+1,U)
  ENDDO
  CLOSE(48)
END SUBROUTINE PVLS

SUBROUTINE BCND
END SUBROUTINE BCND
SUBROUTINE ICND
END SUBROUTINE ICND
SUBROUTINE FOPT
END SUBROUTINE FOPT
)";

std::string source(const systems::Formulas& formulas) {
  const int d = formulas.dimension;
  std::vector<int> outputs = formulas.field;
  const std::vector<int>& gradient = formulas.conserved_gradients.front();
  outputs.insert(outputs.end(), gradient.begin(), gradient.end());
  outputs.insert(outputs.end(), formulas.variations.begin(), formulas.variations.end());
  const auto input = [d](int number) -> std::string {
    if (number < d) return fmt::format("U({})", number + 1);
    return (number - d) / d == (number - d) % d ? "1d0" : "0d0";  // an entry of the identity
  };
  const auto parameter = [&](int number) {
    return systems::fortran_literal(formulas.values[static_cast<std::size_t>(number)]);
  };
  const systems::FortranCode code = systems::fortran_code(formulas.graph, outputs, input, parameter);
  const auto result = [&](int i) { return code.results[static_cast<std::size_t>(i)]; };
  std::string text = fmt::format(
      "SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)\n  IMPLICIT NONE\n"
      "  INTEGER, INTENT(IN) :: NDIM, IJAC, ICP(*)\n  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)\n"
      "  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)\n  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM,*), DFDP(NDIM,*)\n"
      "  DOUBLE PRECISION v({})\n  {}\n",
      code.lines.size() + 1, fmt::join(code.lines, "\n  "));
  for (int i = 0; i < d; ++i) text += fmt::format("  F({})={}+PAR(1)*{}\n", i + 1, result(i), result(d + i));
  text += "  IF(IJAC==0)RETURN\n";
  for (int i = 0; i < d; ++i)
    for (int c = 0; c < d; ++c) text += fmt::format("  DFDU({},{})={}\n", i + 1, c + 1, result(2 * d + i * d + c));
  text += "  IF(IJAC==1)RETURN\n";
  for (int i = 0; i < d; ++i) text += fmt::format("  DFDP({},1)={}\n", i + 1, result(d + i));
  text += "END SUBROUTINE FUNC\n";
  return text + subroutines;
}

}  // namespace

std::string AutoProgram::obstacle(const TrueOrbit& truth) {
  if (!std::filesystem::is_directory(auto_folder() / "lib")) return "not installed (auto-07p)";
  if (core::run_program({"gfortran", "--version"}, {.quiet = true}) != 0) return "gfortran is not installed";
  if (truth.held().quantity != refine::HeldValue::Quantity::period) return "the period does not pick the orbit";
  return {};
}

AutoProgram::AutoProgram(const Setting& setting, const Directed& guess) : _setting(setting), _guess(guess) {
  core::write_file(_folder.path() / "system.f90", {source(refine::refinable_formulas(*setting.plain()))});
  std::vector<std::string> words{"gfortran",   "-O3", "-march=native", "-fopenmp", "-w", "-fallow-argument-mismatch",
                                 "system.f90", "-o",  "program"};
  for (const auto& entry : std::filesystem::directory_iterator(auto_folder() / "lib"))
    if (entry.path().extension() == ".o") words.push_back(entry.path().string());
  if (core::run_program(words, {.folder = _folder.path()}) != 0)
    throw core::EnvironmentError("gfortran could not compile the system for AUTO-07p; its messages are above");
}

void AutoProgram::prepare(int intervals, double tolerance) const {
  const systems::System& system = *_setting.system();
  const loop::Loop start = loop::in_units(_guess.loop, system.scales());
  const int count = intervals * points;
  std::string text = fmt::format("{} {:.17g}\n", count, start.period);
  for (int j = 0; j <= count; ++j) {
    for (const double z : loop::state_at(start, start.period * j / count)) text += fmt::format(" {:.17g}", z);
    text += "\n";
  }
  core::write_file(_folder.path() / "guess.dat", {text});
  const loop::Loop change = loop::in_units(loop::perturbation(_guess.loop, _guess.tangent), system.scales());
  const double along =
      step * start.period * loop::rms_size(change) / std::abs(_guess.tangent.period() * system.scales().time);
  const double accuracy = std::max(tolerance, least_tolerance);
  core::write_file(
      _folder.path() / "c.run",
      {fmt::format("parnames={{1:'mu',11:'PERIOD'}}\nNDIM={}, NTST={}, NCOL={}, IAD=3, IPLT=0, NINT=0, NMX=2, NPR=0, "
                   "MXBF=0, IID=0, ITMX=8, ITNW=12, NWTN=3, JAC=1\nEPSL={:.0e}, EPSU={:.0e}, EPSS={:.0e}, DS={:.6e}, "
                   "DSMIN=1e-12, DSMAX={:.6e}, IADS=1, NPAR=16, THL={{11:0.0}}, THU={{}}, ILP=0\n"
                   "ISW=1, IPS=2, IRS=0, ISP=0, NBC=0\nICP=['PERIOD','mu']\n",
                   system.dimension(), intervals, points, accuracy, accuracy, accuracy, along, along)});
}

bool AutoProgram::run() const {
  std::error_code ignored;
  std::filesystem::remove(_folder.path() / "found.dat", ignored);
  return core::run_program({(_folder.path() / "program").string()},
                           {.folder = _folder.path(), .input = _folder.path() / "c.run", .quiet = true}) == 0;
}

refine::ShotOrbit AutoProgram::found() const {
  std::ifstream file(_folder.path() / "found.dat");
  int count = 0;
  refine::ShotOrbit orbit;
  file >> count >> orbit.period;
  for (int n = 0; n < count && file; ++n) {
    orbit.fractions.emplace_back();
    file >> orbit.fractions.back();
    std::vector<double>& state = orbit.states.emplace_back(static_cast<std::size_t>(_setting.system()->dimension()));
    for (double& z : state) file >> z;
  }
  if (!file || count == 0) throw core::NumericalError("AUTO-07p makes no step");
  return orbit;
}

}  // namespace orbweaver::cost
