#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "orbweaver/model/formula.hpp"
#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// What indices stand for where a formula is evaluated.
using Indices = std::map<std::string, long>;

/// Nodes of a graph that formulas may become: a hostile text ends there.
constexpr int most_nodes = 2000000;

/// What the names of formulas stand for, and the graph that formulas are written into. Names of indexed things are
/// those of tables: x[3] is x3.
class Scope {
 public:
  explicit Scope(Graph& graph) : _graph(graph) {}

  /// A coordinate, a rate, a parameter. Throws core::InputError "place: ..." for a name that is taken.
  void name(const std::string& name, int node, const std::string& place);
  /// A whole number, for indices.
  void size(const std::string& name, long value, const std::string& place);
  /// What a name, or a name with arguments, is short for. With `adds` it is added to what the name is short for.
  void define(const std::string& name, std::vector<std::string> arguments, PlacedFormula formula,
              const Indices& indices, bool adds = false);
  /// What coordinates of the name are beyond their ends: of a ring, or given by a formula at an index.
  struct Ends {
    long first = 1;
    long last = 1;
    bool cyclic = false;
    std::map<long, PlacedFormula> beyond;
  };
  void ends(const std::string& name, Ends ends) { _ends[name] = std::move(ends); }

  [[nodiscard]] bool knows(const std::string& name) const;
  [[nodiscard]] int node_of(const std::string& name) const { return _names.at(name); }

  /// The node of a formula. Throws core::InputError with place and column.
  int evaluate(const PlacedFormula& formula, const Indices& indices = {});
  /// The whole number that an index is.
  [[nodiscard]] long whole(const PlacedFormula& formula, const Formula& part, const Indices& indices) const;
  /// "x" with its indices as tables have them, "x3".
  [[nodiscard]] std::string flat(const std::string& name, const std::vector<Formula>& index,
                                 const PlacedFormula& formula, const Indices& indices) const;

 private:
  struct Definition {
    std::vector<std::string> arguments;
    std::vector<PlacedFormula> terms;
    std::vector<Indices> indices;
    int node = -1;  // once it is evaluated, where it has no arguments
  };
  struct Bindings {
    const PlacedFormula& formula;
    const Indices& indices;
    const std::map<std::string, int>& arguments;
  };

  void require_free(const std::string& name, const std::string& place) const;
  int evaluate(const Formula& part, const Bindings& bindings);
  int of_name(const Formula& part, const Bindings& bindings);
  int of_call(const Formula& part, const Bindings& bindings);
  int of_sum(const Formula& part, const Bindings& bindings);
  int of_definition(const std::string& name, const std::map<std::string, int>& arguments, const Formula& part,
                    const Bindings& bindings);
  int number(const Formula& part);
  [[noreturn]] void refuse_unknown(const Formula& part, const std::string& name, const Bindings& bindings) const;

  Graph& _graph;
  std::map<std::string, int> _names;
  std::map<std::string, long> _sizes;
  std::map<std::string, Definition> _definitions;
  std::map<std::string, Ends> _ends;
  std::vector<std::string> _open;  // definitions that are being evaluated
};

}  // namespace orbweaver::model
