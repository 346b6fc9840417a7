#pragma once

#include <cstddef>
#include <streambuf>
#include <string>

namespace orbweaver::core {

/// Appends to a string: megabytes are copied once.
class AppendBuffer : public std::streambuf {
 public:
  explicit AppendBuffer(std::string& bytes) : _bytes(bytes) {}

 protected:
  std::streamsize xsputn(const char* data, std::streamsize count) override {
    _bytes.append(data, static_cast<std::size_t>(count));
    return count;
  }
  int_type overflow(int_type c) override {
    _bytes.push_back(traits_type::to_char_type(c));
    return c;
  }

 private:
  std::string& _bytes;
};

/// Counts what is written and drops it.
class CountingBuffer : public std::streambuf {
 public:
  [[nodiscard]] std::size_t bytes() const { return _bytes; }

 protected:
  std::streamsize xsputn(const char*, std::streamsize count) override {
    _bytes += static_cast<std::size_t>(count);
    return count;
  }
  int_type overflow(int_type c) override {
    ++_bytes;
    return c;
  }

 private:
  std::size_t _bytes = 0;
};

}  // namespace orbweaver::core
