#include "variational_step.hpp"

#include <algorithm>

namespace orbweaver::spectrum {

namespace {

constexpr std::size_t stages = 12;

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

/// y += factor * x.
void add(std::size_t size, double factor, const double* x, double* y) {
  for (std::size_t n = 0; n < size; ++n) y[n] += factor * x[n];
}

/// product = a b for dimension x dimension matrices in lanes.
void multiply(std::size_t d, const double* a, const double* b, double* product) {
  constexpr std::size_t w = VariationalStep::lanes;
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t l = 0; l < d; ++l) {
      double sum[w] = {};
      for (std::size_t m = 0; m < d; ++m) {
        const double* left = a + (i * d + m) * w;
        const double* right = b + (m * d + l) * w;
        for (std::size_t lane = 0; lane < w; ++lane) sum[lane] += left[lane] * right[lane];
      }
      std::copy_n(sum, w, product + (i * d + l) * w);
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
      _jacobian(_dimension * _dimension * lanes) {
  for (std::size_t i = 0; i < _dimension; ++i)
    std::fill_n(_start.begin() + static_cast<std::ptrdiff_t>((_dimension + i * _dimension + i) * lanes), lanes, 1.0);
}

void VariationalStep::slope(std::size_t stage) {
  double* slopes = _slopes.data() + stage * _size;
  _system.field_jacobian(lanes, _values.data(), slopes, _jacobian.data());
  multiply(_dimension, _jacobian.data(), transitions(), slopes + _dimension * lanes);
}

void VariationalStep::run(const double* starts, double h) {
  std::copy_n(starts, _dimension * lanes, _start.begin());
  std::size_t row = 0;
  std::copy(_start.begin(), _start.end(), _values.begin());
  for (const Entry& entry : tableau) {
    if (entry.row != row) {
      slope(row);
      row = entry.row;
      std::copy(_start.begin(), _start.end(), _values.begin());
    }
    add(_size, h * entry.weight, _slopes.data() + entry.column * _size, _values.data());
  }
}

}  // namespace orbweaver::spectrum
