#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/core/serialization.hpp"

namespace orbweaver::archive {

inline constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();

/// One row of /families (docs/file_format.md). `key` is the path that identifies the family in any run; rows are sorted
/// by it.
struct FamilyRecord {
  std::string key;
  std::string name;
  std::string parent_key;  ///< empty: none
  int crossing = -1;  ///< where it was born: index into the crossings that are handed over with it (Records), or -1
  int multiplicity = 1;
  std::string isotropy;        ///< "S@1/2 R@0"
  std::string end_reason;      ///< sentence-like text, never empty in a finished archive
  std::string end_family_key;  ///< empty: none
  int end_crossing = -1;       ///< as `crossing`
  /// Of the crossing where it was born, on the family; NaN: it was born at none. Segments tell the arclength of orbits
  /// with steps below zero from here: that side does not know how far the other side's first orbit is from it.
  double birth_arclength = not_computed;
  /// Rows of the segments with other steps are left out: a branch that ran on into what another family covers is cut.
  int first_step = std::numeric_limits<int>::min();
  int last_step = std::numeric_limits<int>::max();
};

/// What the certificate adds to a row of /orbits (docs/mathematics.md, "Certificates").
struct CertificateRecord {
  int verdict = -1;  ///< certificate::Verdict; -1: none was asked for
  double closure = not_computed;
  double single_shot = not_computed;
  double energy_drift = not_computed;
  double taylor_closure = not_computed;
  double integrators_apart = not_computed;
  double other_drift = not_computed;
  double symmetry_defect = not_computed;
  double recurrence = not_computed;
  double orbit_distance = not_computed;
  double contraction = not_computed;
  double pairing = not_computed;
  double index_gap = not_computed;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, verdict, closure, single_shot, energy_drift, taylor_closure, integrators_apart,
                            other_drift, symmetry_defect, recurrence, orbit_distance, contraction, pairing, index_gap);
  }
};

/// One row of /orbits. Columns that were not computed stay NaN. `step` orders the orbits of a family. A family that
/// runs through the crossing it was born at has steps and arclengths below zero on one side of it.
struct OrbitRecord : CertificateRecord {
  std::string family_key;
  int step = 0;
  double arclength = 0.0;
  double period = 0.0;
  double energy = not_computed;
  double action = not_computed;
  double parameter = not_computed;
  int cutoff = 0;
  double loss_rms = 0.0;
  double off_branch_eigenvalue = not_computed;
  std::vector<double> stability;              ///< stability_width(header) values (schema.hpp), or empty: not computed
  std::vector<double> fundamental_stability;  ///< the same
  double stability_error = not_computed;
  double log_volume = not_computed;  ///< of systems whose multipliers do not come in pairs
  std::vector<double> state;         ///< dimension, at s = 0
  double tail = not_computed;
  std::vector<double> modes;     ///< (2 cutoff + 1) x dimension
  std::vector<double> time_map;  ///< kappa, c_1, d_1, ... (loop::to_numbers); empty = identity
  std::vector<double> winding;   ///< one an angle, or empty: not computed
};

/// One row of /crossings.
struct CrossingRecord {
  std::string family_key;
  double arclength = 0.0;
  double period = 0.0;
  double energy = not_computed;
  double parameter = not_computed;
  CrossingKind kind = CrossingKind::branch_point;
  int multiplicity = 1;
  int kernel_dimension = 0;
  double residual = not_computed;
  std::vector<double> state;
  int sector_j = 0;
  int sector_q = 1;
  int fundamental_order = 1;
  double test_value = not_computed;
  double kernel_residual = not_computed;  ///< the largest singular value that counts as zero
  // How far the crossing may lie from there: in arclength, and what these are over it.
  double place_error = not_computed;
  double place_error_period = not_computed;
  double place_error_energy = not_computed;
  double place_error_parameter = not_computed;
};

/// One row of /sections: a crossing of the scene's Poincare section by an orbit (family_key, step).
struct SectionRecord {
  std::string family_key;
  int step = 0;
  double time = 0.0;
  std::vector<double> state;
};

/// One row of /loci: a point of a curve in two parameters along which a crossing or fold persists.
struct LocusRecord {
  std::string family_key;  ///< of the family on which the crossing lies where the curve begins
  int crossing = -1;       ///< that crossing: index into those that are handed over with it (Records)
  int locus = 0;           ///< tells the curves that begin at one crossing apart; numbered through in the archive
  int step = 0;            ///< 0 at the crossing; points to its other side count backwards
  double arclength = 0.0;
  CrossingKind kind = CrossingKind::branch_point;
  double period = 0.0;
  double energy = not_computed;
  double parameter = not_computed;
  double second_parameter = not_computed;
  std::string second_name;
  int sector_j = 0;
  int sector_q = 1;
  int fundamental_order = 1;
  std::vector<double> state;
  std::string note;  ///< "start", "cusp", "return", or why the curve ends there; empty at all others
};

/// One row of /equilibria: an equilibrium that families were looked for at, or a point of its curve in the parameter.
struct EquilibriumRecord {
  int equilibrium = 0;
  int step = 0;            ///< 0 where the scene leads to it; points of the curve to its other side count backwards
  double arclength = 0.0;  ///< by chords, in the survey's scales
  std::string kind;        ///< "equilibrium", "hopf", "fold-parameter", "return", "branch-point"
  double parameter = not_computed;
  std::vector<double> state;
  double energy = not_computed;
  std::string stability;                   ///< of the linearised field; empty: not computed
  std::vector<double> eigenvalues;         ///< of the Jacobian: (re, im) each, dimension of them; or none
  std::vector<double> periods;             ///< of the linear oscillations, longest first: dimension/2; or none
  std::vector<std::int64_t> multiplicity;  ///< oscillations that share each of these periods; or none
  std::string note;
};

/// One row of /findings: what does not add up in a survey, or what its limits cut. Rows are those of the other tables
/// as they are written; -1: none.
struct FindingRecord {
  std::string severity;
  std::string kind;
  int family = -1;
  int other_family = -1;
  int crossing = -1;
  double period = not_computed;
  double energy = not_computed;
  double parameter = not_computed;
  double deviation = not_computed;  ///< how far off, in what the kind is measured in
  std::string text;
};

/// The row of /model.
struct ModelRecord {
  std::string text;
};

/// What stands on the root group and fixes the width of vector columns.
struct Header {
  std::string orbweaver_version;
  std::string scene;  ///< the YAML text
  std::string model;  ///< the model's text (docs/models.md), in /model; empty: it has none, or the file is older
  std::vector<std::string> state_names;
  std::vector<std::string> winding_names;
  std::vector<int> winding_coordinates;  ///< index of each one's coordinate; empty before format_minor 11
  int pairs = 0;                         ///< width of the stability columns
  bool symplectic = true;
  // Empty in files with format_minor 0.
  std::string system;
  std::vector<std::string> effects;
  std::vector<std::string> parameter_names;
  std::vector<double> parameter_values;
  std::vector<std::string> scale_names;  ///< time, coordinates, conserved quantities, parameters that move
  std::vector<double> scales;            ///< of the survey (docs/mathematics.md, "Scales")
};

/// Rows of one family that are no longer valid in the first `before_segment` segments (as listed to `consolidate`): a
/// survey resumed with wider limits computes them again. Later segments hold what stands in their place, if anything.
struct VoidedRows {
  std::string family_key;
  int first_step = std::numeric_limits<int>::min();
  int last_step = std::numeric_limits<int>::max();
  int before_segment = 0;

  static constexpr int wire_version = 1;
  template <class Archive>
  void serialize(Archive& archive, unsigned /*version*/) {
    core::serialize_members(archive, family_key, first_step, last_step, before_segment);
  }
};

/// Records in any order; tables are sorted by key and step when they are written.
struct Records {
  std::vector<FamilyRecord> families;
  std::vector<OrbitRecord> orbits;
  std::vector<CrossingRecord> crossings;
  std::vector<SectionRecord> sections;
  std::vector<LocusRecord> loci;
  std::vector<EquilibriumRecord> equilibria;
  std::vector<std::string> left_out_keys;  ///< families that the archive does not have; rows of theirs are left out
  std::vector<VoidedRows> voided;          ///< several for one family are allowed
  /// Scenes, besides the header's, for which segments may have been written: those before limits were widened.
  std::vector<std::string> earlier_scenes;
  /// For an atlas, one a row of /orbits in its order: they stand in the place of what the segments have. Or none.
  std::vector<CertificateRecord> certificates;
};

}  // namespace orbweaver::archive
