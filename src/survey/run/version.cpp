#include "version.hpp"

namespace orbweaver::survey {

const char* version() { return ORBWEAVER_VERSION; }

}  // namespace orbweaver::survey
