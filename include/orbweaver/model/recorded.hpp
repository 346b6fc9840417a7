#pragma once

#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// The scalar that writes a graph: what a function of the program's does with it becomes nodes.
class Recorded {
 public:
  Recorded() = default;
  /// Throws MisuseError outside of a recording.
  Recorded(double constant);

  [[nodiscard]] int node() const { return _node; }

  friend Recorded operator+(Recorded a, Recorded b);
  friend Recorded operator-(Recorded a, Recorded b);
  friend Recorded operator*(Recorded a, Recorded b);
  friend Recorded operator/(Recorded a, Recorded b);
  friend Recorded operator-(Recorded a);
  Recorded& operator+=(Recorded b) { return *this = *this + b; }
  Recorded& operator-=(Recorded b) { return *this = *this - b; }
  Recorded& operator*=(Recorded b) { return *this = *this * b; }
  Recorded& operator/=(Recorded b) { return *this = *this / b; }
  friend Recorded sqrt(Recorded x);
  friend Recorded exp(Recorded x);
  friend Recorded log(Recorded x);
  friend Recorded sin(Recorded x);
  friend Recorded cos(Recorded x);
  friend Recorded tan(Recorded x);
  friend Recorded asin(Recorded x);
  friend Recorded acos(Recorded x);
  friend Recorded atan(Recorded x);
  friend Recorded sinh(Recorded x);
  friend Recorded cosh(Recorded x);
  friend Recorded tanh(Recorded x);
  friend Recorded erf(Recorded x);
  friend Recorded pow(Recorded x, Recorded exponent);

 private:
  friend class Recording;
  struct Place {
    int node;
  };
  explicit Recorded(Place place) : _node(place.node) {}
  int _node;
};

/// While it lives, what this thread does with Recorded numbers goes into its graph. One at a time; Recorded numbers are
/// used within their own recording only.
class Recording {
 public:
  Recording();
  /// Goes on in a graph that there is.
  explicit Recording(Graph graph);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] Recorded input(int number);
  [[nodiscard]] Recorded parameter(int number);
  [[nodiscard]] Recorded at(int node) const { return Recorded(Recorded::Place{node}); }
  [[nodiscard]] Graph& graph() { return _graph; }
  [[nodiscard]] const Graph& graph() const { return _graph; }

 private:
  Graph _graph;
};

}  // namespace orbweaver::model
