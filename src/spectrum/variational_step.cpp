#include "variational_step.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "orbweaver/ad/lanes.hpp"

namespace orbweaver::spectrum {

namespace {

using ad::Lanes;

constexpr std::size_t stages = 12;
constexpr std::size_t w = VariationalStep::lanes;
/// The estimate is e5^2 / sqrt(e5^2 + 0.01 e3^2), as in DOP853 (Hairer, Norsett and Wanner 1993, II.10).
constexpr double share_of_third = 0.01;
/// Below the squares of all errors: unused lanes hold zeros.
constexpr double never_zero = 1e-300;

/// Stage `row` (the last one: the result) takes h * weight of the slope at stage `column`.
struct Entry {
  std::size_t row;
  std::size_t column;
  double weight;
};

/// Dormand and Prince's method of order 8 with 12 stages.
constexpr Entry tableau[] = {
    {1, 0, 0.052600151958767729643},   {2, 0, 0.019725056984537900351},  {2, 1, 0.059175170953613701053},
    {3, 0, 0.029587585476806850526},   {3, 2, 0.08876275643042054464},   {4, 0, 0.24136513415926669213},
    {4, 2, -0.88454947932828609236},   {4, 3, 0.92483400326179199258},   {5, 0, 0.037037037037037034981},
    {5, 3, 0.1708286087294738631},     {5, 4, 0.12546768756682241674},   {6, 0, 0.037109375},
    {6, 3, 0.17025221101954404745},    {6, 4, 0.060216538980455959484},  {6, 5, -0.017578125},
    {7, 0, 0.037092000118504789286},   {7, 3, 0.17038392571223998084},   {7, 4, 0.10726203044637327988},
    {7, 5, -0.015319437748624402038},  {7, 6, 0.0082737891638140232536}, {8, 0, 0.62411095871607569219},
    {8, 3, -3.3608926294469414486},    {8, 4, -0.86821934684172596963},  {8, 5, 27.592099699446709593},
    {8, 6, 20.154067550477893889},     {8, 7, -43.489884181069960789},   {9, 0, 0.47766253643826434017},
    {9, 3, -2.4881146199716677181},    {9, 4, -0.5902908268368429745},   {9, 5, 21.230051448181193052},
    {9, 6, 15.279233632882423422},     {9, 7, -33.288210968984863314},   {9, 8, -0.020331201708508626902},
    {10, 0, -0.93714243008598729912},  {10, 3, 5.1863724288440637977},   {10, 4, 1.0914373489967295061},
    {10, 5, -8.1497870107469267964},   {10, 6, -18.520065659996959084},  {10, 7, 22.739487099350505162},
    {10, 8, 2.4936055526796523374},    {10, 9, -3.0467644718982196395},  {11, 0, 2.2733101475165380378},
    {11, 3, -10.534495466737249458},   {11, 4, -2.0008720582248624709},  {11, 5, -17.958931863118799299},
    {11, 6, 27.948884529419959932},    {11, 7, -2.8589982771350235247},  {11, 8, -8.8728569335306293198},
    {11, 9, 12.360567175794303196},    {11, 10, 0.64339274601576357249}, {12, 0, 0.054293734116568764803},
    {12, 5, 4.4503128927524091552},    {12, 6, 1.8915178993145003172},   {12, 7, -5.8012039600105849146},
    {12, 8, 0.31116436695781990451},   {12, 9, -0.15216094966251608733}, {12, 10, 0.20136540080403034225},
    {12, 11, 0.044710615727772587413},
};

/// Result of order 8 less that of order 5, and weights of the slopes in the result of order 3.
constexpr Entry fifth[] = {
    {0, 0, 0.01312004499419488073250102996},  {0, 5, -1.225156446376204440720569753},
    {0, 6, -0.4957589496572501915214079952},  {0, 7, 1.664377182454986536961530415},
    {0, 8, -0.3503288487499736816886487290},  {0, 9, 0.3341791187130174790297318841},
    {0, 10, 0.08192320648511571246570742613}, {0, 11, -0.02235530786388629525884427845},
};
constexpr Entry third[] = {
    {0, 0, 0.244094488188976377952755905512},
    {0, 8, 0.733846688281611857341361741547},
    {0, 11, 0.0220588235294117647058823529412},
};

constexpr std::size_t row_begin(std::size_t row) {
  std::size_t n = 0;
  while (n < std::size(tableau) && tableau[n].row < row) ++n;
  return n;
}

/// weight_0 slope_0 + weight_1 slope_1 + ... over `Count` of the `entries` from `Begin` on, unrolled.
template <const auto& entries, std::size_t Begin, std::size_t Count>
Lanes sum_of(const double* slopes, std::size_t size) {
  return [&]<std::size_t... n>(std::index_sequence<n...>) {
    return ((Lanes::load(slopes + entries[Begin + n].column * size) * entries[Begin + n].weight) + ...);
  }
  (std::make_index_sequence<Count>{});
}

/// values = start + lengths * (slopes weighted by the tableau's row).
template <std::size_t Row>
void combine_row(std::size_t size, std::size_t used, const double* start, const double* lengths, const double* slopes,
                 double* values) {
  constexpr std::size_t begin = row_begin(Row);
  constexpr std::size_t count = row_begin(Row + 1) - begin;
  for (std::size_t n = 0; n < size; n += w)
    for (std::size_t g = 0; g < used; g += Lanes::width)
      (Lanes::load(start + n + g) + Lanes::load(lengths + g) * sum_of<tableau, begin, count>(slopes + n + g, size))
          .store(values + n + g);
}

using CombineRow = void (*)(std::size_t, std::size_t, const double*, const double*, const double*, double*);
template <std::size_t... rows>
constexpr std::array<CombineRow, stages> combine_rows(std::index_sequence<rows...>) {
  return {&combine_row<rows + 1>...};
}
constexpr std::array<CombineRow, stages> combine = combine_rows(std::make_index_sequence<stages>{});

/// product = a b for matrices in lanes, of D x D (0: of size d).
template <std::size_t D>
void multiply(std::size_t dynamic, std::size_t used, const double* a, const double* b, double* product) {
  const std::size_t d = D == 0 ? dynamic : D;
  for (std::size_t g = 0; g < used; g += Lanes::width) {
    for (std::size_t i = 0; i < d; ++i) {
      for (std::size_t l = 0; l < d; ++l) {
        Lanes sum = Lanes::load(a + i * d * w + g) * Lanes::load(b + l * w + g);
        for (std::size_t m = 1; m < d; ++m)
          sum += Lanes::load(a + (i * d + m) * w + g) * Lanes::load(b + (m * d + l) * w + g);
        sum.store(product + (i * d + l) * w + g);
      }
    }
  }
}

}  // namespace

VariationalStep::VariationalStep(const systems::System& system)
    : _system(system),
      _dimension(static_cast<std::size_t>(system.dimension())),
      _size(_dimension * (_dimension + 1) * lanes),
      _start(_size),
      _values(_size),
      _slopes(stages * _size),
      _jacobian(_dimension * _dimension * lanes),
      _truncations(_dimension * _dimension * lanes) {
  for (std::size_t i = 0; i < _dimension; ++i)
    std::fill_n(_start.begin() + static_cast<std::ptrdiff_t>((_dimension + i * _dimension + i) * lanes), lanes, 1.0);
}

void VariationalStep::slope(std::size_t stage, std::size_t used) {
  double* slopes = _slopes.data() + stage * _size;
  double* transition_slopes = slopes + _dimension * lanes;
  if (stage == 0) {  // Y is the unit matrix
    _system.field_jacobian(lanes, _values.data(), slopes, transition_slopes);
    return;
  }
  _system.field_jacobian(lanes, _values.data(), slopes, _jacobian.data());
  if (_dimension == 4)
    multiply<4>(4, used, _jacobian.data(), transitions(), transition_slopes);
  else
    multiply<0>(_dimension, used, _jacobian.data(), transitions(), transition_slopes);
}

void VariationalStep::estimate(const double* lengths, std::size_t used) {
  const std::size_t states = _dimension * lanes;
  for (std::size_t g = 0; g < used; g += Lanes::width) {
    const Lanes h = Lanes::load(lengths + g);
    Lanes squares_5(0.0);
    Lanes squares_3(0.0);
    for (std::size_t n = g; n < _truncations.size(); n += w) {
      const double* slopes = _slopes.data() + states + n;
      const Lanes error = h * sum_of<fifth, 0, std::size(fifth)>(slopes, _size);
      const Lanes other = Lanes::load(&_values[states + n]) - Lanes::load(&_start[states + n]) -
                          h * sum_of<third, 0, std::size(third)>(slopes, _size);
      squares_5 += error * error;
      squares_3 += other * other;
      error.store(&_truncations[n]);
    }
    const Lanes share = sqrt(squares_5 / (squares_5 + share_of_third * squares_3 + never_zero));
    for (std::size_t n = g; n < _truncations.size(); n += w)
      (share * Lanes::load(&_truncations[n])).store(&_truncations[n]);
  }
}

void VariationalStep::run(const double* starts, const double* lengths, std::size_t used) {
  std::copy_n(starts, _dimension * lanes, _start.begin());
  std::copy(_start.begin(), _start.end(), _values.begin());
  for (std::size_t row = 0; row < stages; ++row) {
    slope(row, used);
    combine[row](_size, used, _start.data(), lengths, _slopes.data(), _values.data());
  }
  estimate(lengths, used);
}

}  // namespace orbweaver::spectrum
