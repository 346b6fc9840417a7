#pragma once

#include <Eigen/Dense>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

namespace orbweaver::numerics {

/// 113 bits, as IEEE's quadruple precision: for what cancels in double, where it is little enough to be slow.
using Quad = boost::multiprecision::cpp_bin_float_quad;
using QuadVector = Eigen::Matrix<Quad, Eigen::Dynamic, 1>;
using QuadMatrix = Eigen::Matrix<Quad, Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace orbweaver::numerics
