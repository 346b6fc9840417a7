// What a field may not do, all at once.
#include <orbweaver/systems/plugin.hpp>

class Kinked {
 public:
  static constexpr int dimension = 2;
  static constexpr int quantities = 0;
  static orbweaver::systems::ModelInfo info();
  static orbweaver::systems::Structure structure(const orbweaver::systems::Bound&);
  template <class P>
  class With {
   public:
    explicit With(const orbweaver::systems::BoundTo<P>& bound) : _a(bound["a"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      f[0] = abs(z[1]) + max(z[0], 0.0) + pow(z[0], _a);
      f[1] = z[0] > 0.0 ? -z[0] : z[1] * atan2(z[0], z[1]);
    }

   private:
    P _a;
  };
};
ORBWEAVER_SYSTEMS(Kinked);
