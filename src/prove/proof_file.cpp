#include "orbweaver/prove/proof_file.hpp"

#include <charconv>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/archive/file/text_table.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::prove {

namespace {

constexpr const char* table_name = "proofs";
constexpr const char* separator = "; ";  // within a text that holds several

/// The columns, in their order, and what they hold.
template <class AnyProof, class Visit>
void visit_columns(AnyProof& proof, const Visit& visit) {
  auto& statement = proof.statement;
  visit("family", statement.family);
  visit("state_names", statement.state_names);
  visit("system", statement.system);
  visit("parameters", statement.parameters);
  visit("effects", statement.effects);
  visit("time_scale", statement.scales.time);
  visit("coordinate_scales", statement.scales.coordinates);
  visit("conserved_scales", statement.scales.conserved);
  visit("isotropy", statement.isotropy);
  visit("held", statement.held);
  visit("fractions", statement.fractions);
  visit("start", statement.start);
  visit("end", statement.end);
  visit("centre", statement.centre);
  visit("digits", statement.digits);
  visit("bits", statement.bits);
  visit("isolated_by", proof.isolated_by);
  visit("radius", proof.radius);
  visit("distance", proof.distance);
  visit("state", proof.state);
  visit("period", proof.period);
  visit("energy", proof.energy);
  visit("order", proof.order);
  visit("fundamental_index", proof.fundamental_index);
  visit("index", proof.index);
  visit("stability", proof.stability);
  visit("multiplier", proof.multiplier);
  visit("taylor_order", proof.taylor_order);
  visit("steps", proof.steps);
}

std::string to_text(const std::string& text) { return text; }
std::string to_text(double x) { return numerics::shortest_decimal(x); }
std::string to_text(int n) { return std::to_string(n); }
std::string to_text(long n) { return std::to_string(n); }
std::string to_text(const Enclosure& enclosure) { return enclosure.exact; }
std::string to_text(const std::optional<Enclosure>& enclosure) { return enclosure ? enclosure->exact : ""; }
std::string to_text(const std::pair<std::string, std::string>& named) { return named.first + "=" + named.second; }
std::string to_text(const refine::HeldValue& held) {
  return (held.quantity == refine::HeldValue::Quantity::period ? "T=" : "E=") + held.decimal;
}
std::string to_text(Stability stability) { return name_of(stability); }
template <class Value>
std::string to_text(const std::vector<Value>& values) {
  std::vector<std::string> texts;
  for (const Value& value : values) texts.push_back(to_text(value));
  return fmt::format("{}", fmt::join(texts, separator));
}

[[noreturn]] void refuse(const std::string& text) {
  throw core::InputError(fmt::format("a proof holds `{}` where something else was expected", core::printable(text)));
}

void from_text(const std::string& text, std::string& value) { value = text; }
template <class Number>
requires std::is_arithmetic_v<Number>
void from_text(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) refuse(text);
}
void from_text(const std::string& text, Enclosure& value) {
  value.exact = text;
  static_cast<void>(value.radius());
}
void from_text(const std::string& text, std::optional<Enclosure>& value) {
  value.reset();
  if (!text.empty()) from_text(text, value.emplace());
}
void from_text(const std::string& text, std::pair<std::string, std::string>& value) {
  const std::size_t middle = text.find('=');
  if (middle == std::string::npos) refuse(text);
  value = {text.substr(0, middle), text.substr(middle + 1)};
}
void from_text(const std::string& text, refine::HeldValue& value) {
  if (!text.starts_with("T=") && !text.starts_with("E=")) refuse(text);
  value = {text.front() == 'T' ? refine::HeldValue::Quantity::period : refine::HeldValue::Quantity::energy,
           text.substr(2)};
}
void from_text(const std::string& text, Stability& value) {
  for (const Stability known : {Stability::elliptic, Stability::hyperbolic, Stability::undecided, Stability::none})
    if (text == name_of(known)) {
      value = known;
      return;
    }
  refuse(text);
}
template <class Value>
void from_text(const std::string& text, std::vector<Value>& values) {
  values.clear();
  const std::string_view mark(separator);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(mark, begin), text.size());
    from_text(text.substr(begin, end - begin), values.emplace_back());
    begin = end + mark.size();
  }
}

archive::TextTable empty_table() {
  archive::TextTable table{proofs_format, proofs_version, table_name, {}, {}};
  Proof proof;
  visit_columns(proof, [&](const char* name, const auto&) { table.columns.emplace_back(name); });
  return table;
}

}  // namespace

void write_proofs(const std::filesystem::path& path, const std::vector<Proof>& proofs) {
  archive::TextTable table = empty_table();
  table.values.resize(table.columns.size());
  for (const Proof& proof : proofs) {
    std::size_t column = 0;
    visit_columns(proof, [&](const char*, const auto& value) { table.values[column++].push_back(to_text(value)); });
  }
  archive::write_text_table(path, table);
}

std::vector<Proof> read_proofs(const std::filesystem::path& path) {
  const archive::TextTable table = archive::read_text_table(path, empty_table());
  std::vector<Proof> proofs(table.values.front().size());
  for (std::size_t row = 0; row < proofs.size(); ++row) {
    std::size_t column = 0;
    visit_columns(proofs[row], [&](const char*, auto& value) { from_text(table.values[column++][row], value); });
  }
  return proofs;
}

bool is_proofs_file(const std::filesystem::path& path) { return archive::format_of(path) == proofs_format; }

}  // namespace orbweaver::prove
