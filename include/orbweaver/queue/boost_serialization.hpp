#pragma once

#include <boost/serialization/level.hpp>
#include <boost/serialization/tracking.hpp>

#include "orbweaver/core/serialization.hpp"

// Types that list their members (core/serialization.hpp) go without Boost's class information and tracking: versions
// and layouts are checked as a whole by whoever opens the bytes, and nothing is shared by pointer. It also compiles
// faster.

namespace boost::serialization {

template <orbweaver::core::Serialized T>
struct implementation_level_impl<const T> {
  using tag = mpl::integral_c_tag;
  using type = mpl::int_<object_serializable>;
  static constexpr int value = type::value;
};

template <orbweaver::core::Serialized T>
struct tracking_level_impl<const T> {
  using tag = mpl::integral_c_tag;
  using type = mpl::int_<track_never>;
  static constexpr int value = type::value;
};

}  // namespace boost::serialization
