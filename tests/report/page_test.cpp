#include "orbweaver/report/page/page.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <sstream>

#include "archive/sample.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "page/encoding.hpp"
#include "page/page_index.hpp"
#include "page/thinned_loop.hpp"
#include "stored_system.hpp"

namespace page_test {
namespace {

using namespace orbweaver;
using ::testing::HasSubstr;
using ::testing::Not;

/// What a page does with the bytes of a thinned loop (drivers/page/web/src/data/loop.ts).
class ReadBack {
 public:
  ReadBack(const std::vector<std::uint8_t>& bytes, int dimension) : _bytes(bytes) {
    for (int channel = 0; channel <= dimension; ++channel) channels.push_back(read_channel());
    bins = count();
    width = count();
    for (int i = 0; i < dimension; ++i)
      for (std::uint64_t bin = 0; bin < bins; ++bin) spectrum.push_back(_bytes.at(_at++));
    left = _bytes.size() - _at;
  }

  [[nodiscard]] double value(std::size_t channel, double s) const {
    const std::vector<double>& modes = channels[channel];
    double sum = modes[0];
    for (std::size_t k = 1; 2 * k < modes.size(); ++k) {
      const double angle = static_cast<double>(k) * s;
      sum += modes[2 * k - 1] * std::cos(angle) + modes[2 * k] * std::sin(angle);
    }
    return sum;
  }

  std::vector<std::vector<double>> channels;  ///< the time first; mean, a_1, b_1, ...
  std::vector<int> spectrum;
  std::uint64_t bins = 0;
  std::uint64_t width = 0;
  std::size_t left = 0;

 private:
  double real() {
    std::uint64_t bits = 0;
    for (int shift = 0; shift < 64; shift += 8) bits |= static_cast<std::uint64_t>(_bytes.at(_at++)) << shift;
    return std::bit_cast<double>(bits);
  }
  std::uint64_t count() {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const std::uint8_t byte = _bytes.at(_at++);
      value |= static_cast<std::uint64_t>(byte & 127) << shift;
      if (byte < 128) return value;
    }
  }
  std::vector<double> read_channel() {
    const double step = real();
    std::vector<double> modes{real()};
    for (std::uint64_t left_over = 2 * count(); left_over > 0; --left_over) {
      const std::uint64_t zigzag = count();
      const auto number = static_cast<std::int64_t>(zigzag >> 1) ^ -static_cast<std::int64_t>(zigzag & 1);
      modes.push_back(static_cast<double>(number) * step);
    }
    return modes;
  }

  std::vector<std::uint8_t> _bytes;
  std::size_t _at = 0;
};

/// A narrow bump in one coordinate, a circle in two others, and one that is at rest but for rounding.
loop::Loop sharp_loop() {
  loop::Loop loop;
  loop.dimension = 4;
  loop.cutoff = 400;
  loop.period = 7.5;
  loop.winding.assign(4, 0.0);
  loop.modes.assign(801 * 4, 0.0);
  loop.cosine(0, 0) = 100.0;
  for (int k = 1; k <= 400; ++k) loop.cosine(k, 0) = std::exp(-0.05 * k);
  loop.cosine(1, 1) = 2.0;
  loop.sine(1, 2) = 2.0;
  loop.sine(7, 3) = 1e-15;
  return loop;
}

TEST(ThinnedLoop, IsWithinTheToleranceOfTheLoop) {
  loop::Loop loop = sharp_loop();
  loop.time_map.kappa = 3.0;
  loop.time_map.coefficients = {0.1, 0.05};
  const report::ThinnedLoop thinned = report::thinned(loop, report::page_tolerance);
  const ReadBack read(thinned.bytes, loop.dimension);
  EXPECT_EQ(read.left, 0U);
  EXPECT_LE(thinned.deviation, report::page_tolerance);
  EXPECT_GT(thinned.deviation, report::page_tolerance / 10) << "more digits than the eye needs";
  const loop::Samples samples = loop::samples_of(loop, 3000);
  const std::vector<double> ranges{38.0, 4.0, 4.0, 1e-4 * 38.0};
  for (int j = 0; j < samples.nodes; ++j) {
    const double s = 2 * std::numbers::pi * j / samples.nodes;
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(read.value(i + 1, s), samples.states[i * 3000 + static_cast<std::size_t>(j)],
                  1.1 * report::page_tolerance * ranges[i]);
    EXPECT_NEAR(read.value(0, s), (loop.time_map.phase(s) - s) / (2 * std::numbers::pi), 1.1 * report::page_tolerance);
  }
}

TEST(ThinnedLoop, KeepsNoHarmonicsThatTheEyeDoesNotNeed) {
  const report::ThinnedLoop thinned = report::thinned(sharp_loop(), report::page_tolerance);
  // exp(-0.05 k) summed beyond 170 is a two-hundred-thousandth of the sum.
  EXPECT_LT(thinned.harmonics, 170);
  EXPECT_GT(thinned.harmonics, 40);
  EXPECT_LT(thinned.bytes.size(), 1000U);
  EXPECT_LT(report::thinned(sharp_loop(), 1e-2).bytes.size(), thinned.bytes.size());
}

TEST(ThinnedLoop, TellsAmplitudeExtremaAndSpectrum) {
  loop::Loop loop = sharp_loop();
  const report::ThinnedLoop thinned = report::thinned(loop, report::page_tolerance);
  EXPECT_DOUBLE_EQ(thinned.amplitude, loop::rms_amplitude(loop));
  EXPECT_NEAR(thinned.largest[1], 2.0, 1e-9);
  EXPECT_NEAR(thinned.largest[2], 2.0, 1e-9);
  const ReadBack read(thinned.bytes, loop.dimension);
  EXPECT_EQ(read.width, 5U);  // 400 harmonics in at most 96 bins
  EXPECT_EQ(read.bins, 80U);
  EXPECT_EQ(read.spectrum[0], report::spectrum_byte(std::exp(-0.05)));
  EXPECT_EQ(read.spectrum[80], report::spectrum_byte(2.0));
  EXPECT_EQ(read.spectrum[81], 0);
  loop.winding[0] = 1.0;
  EXPECT_TRUE(std::isnan(report::thinned(loop, report::page_tolerance).largest[0]));
}

TEST(ThinnedLoop, HasAConstantLoop) {
  const std::vector<double> point{1.0, 2.0};
  const report::ThinnedLoop thinned = report::thinned(loop::constant_loop(point, 1.0, 3), report::page_tolerance);
  const ReadBack read(thinned.bytes, 2);
  EXPECT_EQ(read.value(2, 0.3), 2.0);
  EXPECT_EQ(thinned.harmonics, 0);
}

TEST(Encoding, IsThatOfTheStandards) {
  const auto encoded = [](const std::string& text) {
    return report::base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  // RFC 4648, section 10.
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  const std::vector<std::uint8_t> packed = report::deflated(std::vector<std::uint8_t>(1000, 7));
  EXPECT_LT(packed.size(), 30U);
  EXPECT_EQ(packed[0], 0x78);  // RFC 1950
}

class Page : public ::testing::Test {
 protected:
  /// As the sample, with loops that are loops.
  static archive::Records records(const archive::Header& header, const std::string& name) {
    archive::Records records = test::sample_records(header);
    for (archive::OrbitRecord& orbit : records.orbits) {
      orbit.cutoff = 20;
      orbit.modes.assign(41 * 2, 0.0);
      for (std::size_t i = 2; i < orbit.modes.size(); ++i)
        orbit.modes[i] = std::exp(-0.2 * static_cast<double>(i)) * std::cos(static_cast<double>(i * i));
      orbit.time_map.clear();
    }
    records.families[1].name = name;
    return records;
  }
  static report::PageSummary write(const std::string& name, std::string& page,
                                   std::size_t loop_bytes = report::most_loop_bytes) {
    const archive::Header header = test::sample_header();
    const archive::Archive atlas(test::write_sample_atlas(test::fresh_folder("page"), header, records(header, name)));
    std::ostringstream out;
    const report::PageSummary summary = report::write_page(out, atlas, "<head>\n<!-- atlas -->\n</html>", loop_bytes);
    page = out.str();
    return summary;
  }
};

TEST_F(Page, HoldsEverythingOnceAndSaysHowMuch) {
  std::string page;
  const report::PageSummary summary = write("In-Phase", page);
  EXPECT_EQ(summary.bytes, page.size());
  EXPECT_EQ(summary.families, 5U);
  EXPECT_EQ(summary.orbits, 29U);
  EXPECT_EQ(summary.loops, 29U);
  EXPECT_EQ(summary.harmonics_stored, 29U * 20U);
  EXPECT_LT(summary.harmonics_kept, summary.harmonics_stored);
  EXPECT_LE(summary.deviation, report::page_tolerance);
  EXPECT_THAT(page, ::testing::StartsWith("<head>\n<script type=\"text/plain\" id=\"atlas-index\">"));
  EXPECT_THAT(page, ::testing::EndsWith("</script>\n\n</html>"));
  EXPECT_THAT(page, HasSubstr("id=\"atlas-columns\""));
  EXPECT_THAT(page, HasSubstr("id=\"atlas-loops\""));
  std::string again;
  write("In-Phase", again);
  EXPECT_EQ(page, again);
}

TEST_F(Page, NeverHasATextOfTheArchiveAsMarkup) {
  std::string page;
  write("</script><script>alert(1)</script><!-- &lt; \" ' \\", page);
  std::size_t scripts = 0;
  for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 3U);
  EXPECT_THAT(page, Not(HasSubstr("alert")));
  EXPECT_THAT(page, Not(HasSubstr("<!--")));
}

TEST_F(Page, LeavesLoopsOutWhereThereAreTooMany) {
  std::string page;
  const report::PageSummary all = write("In-Phase", page);
  const report::PageSummary some = write("In-Phase", page, 50);
  EXPECT_LT(some.loops, all.loops);
  EXPECT_GE(some.loops, 2U * 4U) << "the first and last orbit of each family keep theirs";
  EXPECT_EQ(some.orbits, all.orbits);
}

TEST_F(Page, WantsAPlaceForTheData) {
  const archive::Header header = test::sample_header();
  const archive::Archive atlas(test::write_sample_atlas(test::fresh_folder("page"), header, records(header, "A")));
  std::ostringstream out;
  EXPECT_THROW(report::write_page(out, atlas, "<html></html>"), core::MisuseError);
}

TEST_F(Page, TellsTheSystemInItsIndex) {
  archive::Header header = test::sample_header();
  const archive::Archive atlas(test::write_sample_atlas(test::fresh_folder("page"), header, records(header, "A\n\"")));
  const std::string index = report::index_members(atlas);
  EXPECT_THAT(index, HasSubstr("\"system\":\"made_up\""));
  EXPECT_THAT(index, HasSubstr("\"A\\u000a\\\"\""));
  EXPECT_THAT(index, HasSubstr("\"angles\":[0]"));
  EXPECT_THAT(index, HasSubstr("\"meaning\":\"\""));
  EXPECT_THAT(index, HasSubstr("\"moving\":\"\""));
  EXPECT_THAT(index, HasSubstr("\"parameterValues\":[0.10000000000000001,9.8100000000000005]"));
  EXPECT_THAT(index, Not(HasSubstr("checksum")));
  header.system = "double_pendulum";
  header.winding_names = {"n1", "n2"};
  header.parameter_names = {"m1"};
  header.parameter_values = {2.0};
  header.effects.clear();
  header.winding_coordinates.clear();  // as before format_minor 11
  EXPECT_THAT(report::known_angles_of(header), ::testing::Optional(::testing::ElementsAre(0, 1)));
  EXPECT_EQ(report::meaning_of(header), "two point masses on massless rods under gravity");
}

}  // namespace
}  // namespace page_test
