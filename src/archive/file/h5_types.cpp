#include "h5_types.hpp"

#include <algorithm>

namespace orbweaver::archive {

namespace {

H5Handle copy_type(hid_t type) { return {check_h5(H5Tcopy(type), "H5Tcopy"), H5Tclose}; }

}  // namespace

H5Handle h5_text_type(std::size_t width) {
  H5Handle type = copy_type(H5T_C_S1);
  check_h5(H5Tset_size(type.get(), width), "H5Tset_size");
  check_h5(H5Tset_cset(type.get(), H5T_CSET_UTF8), "H5Tset_cset");
  check_h5(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "H5Tset_strpad");
  return type;
}

H5Handle h5_file_type(const ColumnSpec& spec) {
  switch (spec.type) {
    case ColumnType::integer: return copy_type(H5T_STD_I64LE);
    case ColumnType::text: return h5_text_type(spec.text_width);
    case ColumnType::real: break;
  }
  return copy_type(H5T_IEEE_F64LE);
}

H5Handle h5_memory_type(const ColumnSpec& spec) {
  switch (spec.type) {
    case ColumnType::integer: return copy_type(H5T_NATIVE_INT64);
    case ColumnType::text: return h5_text_type(spec.text_width);
    case ColumnType::real: break;
  }
  return copy_type(H5T_NATIVE_DOUBLE);
}

std::size_t longest_text(const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  return width;
}

std::string padded_texts(const std::vector<std::string>& texts, std::size_t width) {
  std::string block(texts.size() * width, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(block.data() + i * width, width);
  return block;
}

}  // namespace orbweaver::archive
