#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace orbweaver::report {

/// zlib's format (RFC 1950), which browsers read as `deflate`. The same bytes for the same input.
[[nodiscard]] std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes);

/// Base64 (RFC 4648) with padding.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace orbweaver::report
