// No field: z -> f(z).
#include <orbweaver/systems/plugin.hpp>

class Map {
 public:
  static constexpr int dimension = 1;
  static constexpr int quantities = 0;
  static orbweaver::systems::ModelInfo info();
  static orbweaver::systems::Structure structure(const orbweaver::systems::Bound&);
  template <class P>
  class With {
   public:
    explicit With(const orbweaver::systems::BoundTo<P>&) {}
    template <class S>
    void next(const S* z, S* image) const {
      image[0] = 1.0 - z[0] * z[0];
    }
  };
};
ORBWEAVER_SYSTEMS(Map);
