#include "fuzz/kinds.hpp"
#include "orbweaver/prove/proof_file.hpp"

namespace orbweaver::fuzz {

namespace {

const std::vector<std::string> words{
    "HDF", "OHDR", "TREE", "SNOD", "HEAP", std::string(8, '\0'), std::string(8, '\xff'), "ffffffffffffffff", "-", "; "};

/// Nothing is proven: what a file holds, not whether it is true.
prove::Proof sample(const std::string& family) {
  const prove::Enclosure one{"1 0 1 -40"};
  prove::Proof proof;
  proof.statement.family = family;
  proof.statement.state_names = {"q", "p"};
  proof.statement.system = "harmonic_oscillator";
  proof.statement.parameters = {{"omega", "2"}};
  proof.statement.scales.coordinates = {1.0, 1.0};
  proof.statement.fractions = {0.0, 0.5};
  proof.statement.start = proof.statement.end = proof.statement.centre = {one.exact, one.exact};
  proof.statement.digits = 15;
  proof.statement.bits = 80;
  proof.isolated_by = "E = 1";
  proof.radius = 1e-12;
  proof.state = {one, one};
  proof.period = proof.energy = one;
  proof.multiplier = {one, one};
  return proof;
}

bool are_same(const prove::Proof& a, const prove::Proof& b) {
  return a.statement.family == b.statement.family && a.statement.start == b.statement.start &&
         a.period.exact == b.period.exact && a.state.size() == b.state.size() && a.radius == b.radius &&
         a.statement.bits == b.statement.bits;
}

}  // namespace

Kind proofs(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "proofs.h5";
  const std::vector<prove::Proof> written{sample("In-Phase"), sample("Out-Phase")};
  prove::write_proofs(file, written);
  return {[whole = bytes_of(file)](Mutator& mutator) {
            if (mutator.below(2) == 0) return mutator.changed(whole, words);
            std::string bytes = whole;
            bytes[mutator.below(bytes.size())] = static_cast<char>(mutator.below(256));
            return bytes;
          },
          [file, written](const std::string& bytes) {
            write_bytes(file, bytes);
            static_cast<void>(prove::is_proofs_file(file));
            const std::vector<prove::Proof> read = prove::read_proofs(file);
            bool same = read.size() == written.size();
            for (std::size_t n = 0; same && n < read.size(); ++n) same = are_same(read[n], written[n]);
            if (!same) throw WrongReading{"other proofs than were written"};
          }};
}

}  // namespace orbweaver::fuzz
