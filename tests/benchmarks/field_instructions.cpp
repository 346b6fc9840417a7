// What a composed field costs beside one written by hand: calls one of them as often as it is told, for an instruction
// counter (tests/benchmarks/field_instructions.py runs valgrind).
//   field_instructions NAME EFFECTS(comma or -) system|hand COUNT
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "orbweaver/systems/model/model_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace {

namespace systems = orbweaver::systems;
using Parameters = std::map<std::string, double>;

constexpr std::size_t nodes = 256;

// Fields as one writes them with only these terms in mind; constants are worked out beforehand.

struct RodInertia {
  static constexpr int dimension = 4;
  double a, b, c, e, g1, g2;
  explicit RodInertia(const Parameters& p) {
    const double m1 = p.at("m1"), m2 = p.at("m2"), l1 = p.at("l1"), l2 = p.at("l2"), r1 = p.at("rod1"),
                 r2 = p.at("rod2");
    a = (m1 + r1 / 3 + m2 + r2) * l1 * l1;
    b = (m2 + r2 / 3) * l2 * l2;
    c = (m2 + r2 / 2) * l1 * l2;
    e = a * b - c * c;
    g1 = (m1 + r1 / 2 + m2 + r2) * l1 * p.at("g");
    g2 = (m2 + r2 / 2) * l2 * p.at("g");
  }
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S q1 = -(z[3] * z[3] * s + sin(z[0]) * g1);
    const S q2 = z[2] * z[2] * s - sin(z[1]) * g2;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
  }
};

/// Bobs on massless rods, with what effects need.
struct Bobs {
  double a, b, c, e, h1, h2, g;
  explicit Bobs(const Parameters& p) {
    const double m1 = p.at("m1"), m2 = p.at("m2"), l1 = p.at("l1"), l2 = p.at("l2");
    a = (m1 + m2) * l1 * l1;
    b = m2 * l2 * l2;
    c = m2 * l1 * l2;
    e = m1 * m2 * l1 * l1 * l2 * l2;
    h1 = (m1 + m2) * l1;
    h2 = m2 * l2;
    g = p.at("g");
  }
};

struct TorsionSprings : Bobs {
  static constexpr int dimension = 4;
  double k1, k2, rest1, rest2, g1, g2;
  explicit TorsionSprings(const Parameters& p)
      : Bobs(p),
        k1(p.at("spring1")),
        k2(p.at("spring2")),
        rest1(p.at("rest1")),
        rest2(p.at("rest2")),
        g1(h1 * g),
        g2(h2 * g) {}
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S joint = (z[1] - z[0] - rest2) * k2;
    const S q1 = joint - (z[0] - rest1) * k1 - z[3] * z[3] * s - sin(z[0]) * g1;
    const S q2 = z[2] * z[2] * s - sin(z[1]) * g2 - joint;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
  }
};

struct JointDamping : Bobs {
  static constexpr int dimension = 4;
  double c1, c2, g1, g2;
  explicit JointDamping(const Parameters& p) : Bobs(p), c1(p.at("c1")), c2(p.at("c2")), g1(h1 * g), g2(h2 * g) {}
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S joint = (z[3] - z[2]) * c2;
    const S q1 = joint - z[2] * c1 - z[3] * z[3] * s - sin(z[0]) * g1;
    const S q2 = z[2] * z[2] * s - sin(z[1]) * g2 - joint;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
  }
};

constexpr double radians = 0.017453292519943295;

struct PivotDrive : Bobs {
  static constexpr int dimension = 5;
  double x, y, w;
  explicit PivotDrive(const Parameters& p) : Bobs(p), w(p.at("drive_frequency")) {
    x = p.at("pivot_amplitude") * w * w * std::sin(p.at("pivot_direction") * radians);
    y = p.at("pivot_amplitude") * w * w * std::cos(p.at("pivot_direction") * radians);
  }
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S wave = cos(z[4]);
    const S side = wave * x;
    const S down = g - wave * y;
    const S q1 = (cos(z[0]) * side - sin(z[0]) * down) * h1 - z[3] * z[3] * s;
    const S q2 = (cos(z[1]) * side - sin(z[1]) * down) * h2 + z[2] * z[2] * s;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
    f[4] = S(w);
  }
};

struct JointTorque : Bobs {
  static constexpr int dimension = 5;
  double t1, a1, t2, a2, g1, g2, w;
  explicit JointTorque(const Parameters& p)
      : Bobs(p),
        t1(p.at("torque1")),
        a1(p.at("torque1_amplitude")),
        t2(p.at("torque2")),
        a2(p.at("torque2_amplitude")),
        g1(h1 * g),
        g2(h2 * g),
        w(p.at("drive_frequency")) {}
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S wave = cos(z[4]);
    const S joint = wave * a2 + t2;
    const S q1 = wave * a1 + t1 - joint - z[3] * z[3] * s - sin(z[0]) * g1;
    const S q2 = z[2] * z[2] * s - sin(z[1]) * g2 + joint;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
    f[4] = S(w);
  }
};

struct AllOfThePendulum {
  static constexpr int dimension = 5;
  double a, b, c, e, h1, h2, g, k1, k2, rest1, rest2, c1, c2, x, y, t1, a1, t2, a2, w;
  explicit AllOfThePendulum(const Parameters& p) {
    const RodInertia rods(p);
    a = rods.a;
    b = rods.b;
    c = rods.c;
    e = rods.e;
    g = p.at("g");
    h1 = rods.g1 / g;
    h2 = rods.g2 / g;
    k1 = p.at("spring1");
    k2 = p.at("spring2");
    rest1 = p.at("rest1");
    rest2 = p.at("rest2");
    c1 = p.at("c1");
    c2 = p.at("c2");
    const PivotDrive drive(p);
    x = drive.x;
    y = drive.y;
    w = drive.w;
    t1 = p.at("torque1");
    a1 = p.at("torque1_amplitude");
    t2 = p.at("torque2");
    a2 = p.at("torque2_amplitude");
  }
  template <class S>
  void field(const S* z, S* f) const {
    const S d = z[0] - z[1];
    const S s = sin(d) * c;
    const S k = cos(d) * c;
    const S wave = cos(z[4]);
    const S side = wave * x;
    const S down = g - wave * y;
    const S joint = (z[0] - z[1] + rest2) * k2 + (z[2] - z[3]) * c2 + wave * a2 + t2;
    const S q1 = (cos(z[0]) * side - sin(z[0]) * down) * h1 - z[3] * z[3] * s - (z[0] - rest1) * k1 - z[2] * c1 +
                 wave * a1 + t1 - joint;
    const S q2 = (cos(z[1]) * side - sin(z[1]) * down) * h2 + z[2] * z[2] * s + joint;
    const S share = 1.0 / (s * s + e);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (q1 * b - q2 * k) * share;
    f[3] = (q2 * a - q1 * k) * share;
    f[4] = S(w);
  }
};

struct Radiation {
  static constexpr int dimension = 4;
  double mu, g1, g2;
  explicit Radiation(const Parameters& p) : mu(p.at("mu")), g1((1 - mu) * (1 - p.at("radiation"))), g2(mu) {}
  template <class S>
  void field(const S* z, S* f) const {
    const S x1 = z[0] + mu;
    const S x2 = z[0] + (mu - 1.0);
    const S yy = z[1] * z[1];
    const S s1 = x1 * x1 + yy;
    const S s2 = x2 * x2 + yy;
    const S p1 = 1.0 / (s1 * sqrt(s1)) * g1;
    const S p2 = 1.0 / (s2 * sqrt(s2)) * g2;
    f[0] = z[2];
    f[1] = z[3];
    f[2] = z[3] * 2.0 + z[0] - x1 * p1 - x2 * p2;
    f[3] = z[2] * -2.0 + z[1] - z[1] * (p1 + p2);
  }
};

struct Oblateness {
  static constexpr int dimension = 4;
  double mu, g1, g2, h1, h2, nn, n2;
  explicit Oblateness(const Parameters& p)
      : mu(p.at("mu")), g1(1 - mu), g2(mu), h1(1.5 * p.at("A1") * g1), h2(1.5 * p.at("A2") * g2) {
    nn = 1 + 1.5 * (p.at("A1") + p.at("A2"));
    n2 = 2 * std::sqrt(nn);
    if (p.contains("radiation")) g1 *= 1 - p.at("radiation");
  }
  template <class S>
  void field(const S* z, S* f) const {
    const S x1 = z[0] + mu;
    const S x2 = z[0] + (mu - 1.0);
    const S yy = z[1] * z[1];
    const S s1 = x1 * x1 + yy;
    const S s2 = x2 * x2 + yy;
    const S r1 = sqrt(s1);
    const S r2 = sqrt(s2);
    const S c1 = 1.0 / (s1 * r1);
    const S c2 = 1.0 / (s2 * r2);
    const S p1 = c1 * (c1 * r1 * h1 + g1);
    const S p2 = c2 * (c2 * r2 * h2 + g2);
    f[0] = z[2];
    f[1] = z[3];
    f[2] = z[3] * n2 + z[0] * nn - x1 * p1 - x2 * p2;
    f[3] = z[1] * nn - z[2] * n2 - z[1] * (p1 + p2);
  }
};

template <bool damped, bool driven>
struct Spring {
  static constexpr int dimension = driven ? 5 : 4;
  double k, length, g, c = 0, x = 0, y = 0, w = 0;
  explicit Spring(const Parameters& p)
      : k(p.at("stiffness") / p.at("mass")), length(p.at("length")), g(p.at("gravity")) {
    const double m = p.at("mass");
    if (damped) c = p.at("damping") / m;
    if (driven) {
      x = p.at("drive_amplitude") / m * std::sin(p.at("drive_direction") * radians);
      y = p.at("drive_amplitude") / m * std::cos(p.at("drive_direction") * radians);
      w = p.at("drive_frequency");
    }
  }
  template <class S>
  void field(const S* z, S* f) const {
    const S r = sqrt(z[0] * z[0] + z[1] * z[1]);
    const S pull = (1.0 - 1.0 / r * length) * k;
    f[0] = z[2];
    f[1] = z[3];
    f[2] = -(z[0] * pull);
    f[3] = -(z[1] * pull) - g;
    if constexpr (damped) {
      f[2] = f[2] - z[2] * c;
      f[3] = f[3] - z[3] * c;
    }
    if constexpr (driven) {
      const S wave = cos(z[4]);
      f[2] = f[2] + wave * x;
      f[3] = f[3] + wave * y;
      f[4] = S(w);
    }
  }
};

template <bool damped, bool driven>
struct Duffing {
  static constexpr int dimension = driven ? 3 : 2;
  double alpha, beta, c = 0, force = 0, w = 0;
  explicit Duffing(const Parameters& p) : alpha(p.at("alpha")), beta(p.at("beta")) {
    if (damped) c = p.at("damping");
    if (driven) {
      force = p.at("drive_amplitude");
      w = p.at("drive_frequency");
    }
  }
  template <class S>
  void field(const S* z, S* f) const {
    f[0] = z[1];
    f[1] = -(z[0] * (z[0] * z[0] * beta + alpha));
    if constexpr (damped) f[1] = f[1] - z[1] * c;
    if constexpr (driven) {
      f[1] = f[1] + cos(z[2]) * force;
      f[2] = S(w);
    }
  }
};

/// A field by hand as a model, so that it is called as a composed one is. Only its field is asked for.
template <class Hand>
class ByHand {
 public:
  static constexpr int dimension = Hand::dimension;
  static constexpr int quantities = 0;
  static systems::ModelInfo info() {
    systems::ModelInfo info;
    info.name = "by_hand";
    info.state_names.assign(dimension, "z");
    info.winding_names.assign(dimension, "");
    return info;
  }
  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _hand(bound.parameters) {}
    template <class S>
    void field(const S* z, S* f) const {
      _hand.field(z, f);
    }
    template <class S>
    S action_density(const S*) const {
      return S(0.0);
    }

   private:
    struct Nothing {
      explicit Nothing(const std::map<std::string, P>&) {}
      template <class S>
      void field(const S*, S* f) const {
        for (int i = 0; i < dimension; ++i) f[i] = S(0.0);
      }
    };
    std::conditional_t<std::is_same_v<P, double>, Hand, Nothing> _hand;
  };
};

using Make = std::shared_ptr<const systems::System> (*)(const Parameters& parameters);

template <class Hand>
std::shared_ptr<const systems::System> by_hand(const Parameters& parameters) {
  return std::make_shared<const systems::ModelSystem<ByHand<Hand>>>(systems::Bound{parameters, {}});
}

const std::map<std::string, Make> hands{
    {"double_pendulum rod_inertia", by_hand<RodInertia>},
    {"double_pendulum torsion_springs", by_hand<TorsionSprings>},
    {"double_pendulum damping", by_hand<JointDamping>},
    {"double_pendulum pivot_drive", by_hand<PivotDrive>},
    {"double_pendulum joint_torque", by_hand<JointTorque>},
    {"double_pendulum rod_inertia,torsion_springs,damping,pivot_drive,joint_torque", by_hand<AllOfThePendulum>},
    {"pcr3bp radiation", by_hand<Radiation>},
    {"pcr3bp oblateness", by_hand<Oblateness>},
    {"pcr3bp radiation,oblateness", by_hand<Oblateness>},
    {"swinging_spring damping", by_hand<Spring<true, false>>},
    {"swinging_spring drive", by_hand<Spring<false, true>>},
    {"swinging_spring damping,drive", by_hand<Spring<true, true>>},
    {"duffing damping", by_hand<Duffing<true, false>>},
    {"duffing drive", by_hand<Duffing<false, true>>},
    {"duffing damping,drive", by_hand<Duffing<true, true>>},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc == 1) {
    for (const auto& [key, make] : hands) std::printf("%s\n", key.c_str());
    return 0;
  }
  if (argc != 5) return 2;
  const std::string name = argv[1];
  const std::string list = argv[2];
  std::vector<std::string> effects;
  std::istringstream stream(list == "-" ? "" : list);
  for (std::string effect; std::getline(stream, effect, ',');) effects.push_back(effect);
  const auto system = systems::make_system(name, {}, effects);
  const auto d = static_cast<std::size_t>(system->dimension());
  std::vector<double> z(d * nodes);
  std::vector<double> f(d * nodes);
  std::vector<double> jacobian(d * d * nodes);
  for (std::size_t n = 0; n < z.size(); ++n) z[n] = 0.3 + 0.002 * static_cast<double>(n * 37 % 501);
  const auto called = std::string(argv[3]) == "hand" ? hands.at(name + " " + list)(system->parameters()) : system;
  double sum = 0.0;
  for (int n = std::atoi(argv[4]); n > 0; --n) {
    called->field_jacobian(nodes, z.data(), f.data(), jacobian.data());
    sum += f.front() + jacobian.back();
  }
  std::printf("%.14g\n", sum);
  return 0;
}
