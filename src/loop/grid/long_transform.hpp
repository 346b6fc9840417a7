#pragma once

namespace orbweaver::loop {

/// Nodes whose transforms take a tenth of a millisecond or more: before each the work may be given up.
constexpr int long_transform = 1 << 14;

}  // namespace orbweaver::loop
