#include "columns.hpp"

namespace orbweaver::archive {

namespace {

constexpr RowNumber row_number{};
constexpr Checksum checksum{};

}  // namespace

const ColumnDefinitions<FamilyRecord>& family_columns() {
  static const ColumnDefinitions<FamilyRecord> columns{
      {"name", &FamilyRecord::name, {"", "name of the family"}},
      {"parent", row_number, {"", "row of /families of the family it branched off, or -1"}},
      {"crossing", row_number, {"", "row of /crossings at which it was born, or -1"}},
      {"multiplicity",
       &FamilyRecord::multiplicity,
       {"", "how many times its orbits go around the parent's orbit where it was born"}},
      {"isotropy",
       &FamilyRecord::isotropy,
       {"", "symmetries of its orbits, each with its time shift or phase as a fraction of the period"}},
      {"first_orbit", row_number, {"", "first of its rows of /orbits"}},
      {"orbit_count", row_number, {"", "number of its rows of /orbits"}},
      {"end_reason", &FamilyRecord::end_reason, {"", "why it ends, in words"}},
      {"end_family", row_number, {"", "row of /families that it joined, or -1"}},
      {"end_crossing", row_number, {"", "row of /crossings at which it ends, or -1"}},
      {"birth_arclength",
       &FamilyRecord::birth_arclength,
       {"", "of the crossing at which it was born, on the family, in the survey's scales; NaN: it was born at none"},
       RowShape::one,
       births_since},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<OrbitRecord>& orbit_columns() {
  static const ColumnDefinitions<OrbitRecord> columns{
      {"family", row_number, {"", "row of /families"}},
      {"step", &OrbitRecord::step, {"", "number along the family"}},
      {"arclength", &OrbitRecord::arclength, {"", "along the family, in the survey's scales; grows with the step"}},
      {"period", &OrbitRecord::period, {"time", "period T"}},
      {"energy", &OrbitRecord::energy, {"energy", "conserved energy; NaN if there is none"}},
      {"action", &OrbitRecord::action, {"energy x time", "closed integral of p dq over the period"}},
      {"parameter",
       &OrbitRecord::parameter,
       {"", "value of the parameter that moves along the families; NaN if none does"}},
      {"cutoff", &OrbitRecord::cutoff, {"", "K, the highest harmonic of the loop"}},
      {"loss_rms", &OrbitRecord::loss_rms, {"scaled state / time", "root mean square over time of dz/dt - f(z)"}},
      {"off_branch_eigenvalue",
       &OrbitRecord::off_branch_eigenvalue,
       {"scaled", "smallest eigenvalue of the Hessian of the loss off the family's direction"}},
      {"stability",
       &OrbitRecord::stability,
       {"",
        "of the period map: one real index mu + 1/mu of the only pair of multipliers; else re, im of each index or "
        "multiplier"},
       RowShape::stability},
      {"fundamental_stability",
       &OrbitRecord::fundamental_stability,
       {"", "the same of the fundamental map, over T/p"},
       RowShape::stability},
      {"stability_error", &OrbitRecord::stability_error, {"", "bound on the absolute error of stability"}},
      {"log_volume",
       &OrbitRecord::log_volume,
       {"", "logarithm of the product of all multipliers; NaN where they come in pairs"},
       RowShape::one,
       volumes_since},
      {"state",
       &OrbitRecord::state,
       {"state", "the point at s = 0, coordinates as in the root attribute state_names"},
       RowShape::state},
      {"closure", &OrbitRecord::closure, {"scaled state", "gap after integrating the orbit again in segments"}},
      {"single_shot", &OrbitRecord::single_shot, {"scaled state", "gap after integrating it once around from state"}},
      {"energy_drift",
       &OrbitRecord::energy_drift,
       {"scaled energy", "largest difference of the energy along the loop"}},
      {"tail", &OrbitRecord::tail, {"scaled state", "largest modulus among the last harmonics"}},
      {"modes_begin", row_number, {"", "first of its values in /modes"}},
      {"modes_count", row_number, {"", "number of its values in /modes: (2 K + 1) x dimension"}},
      {"time_map_begin", row_number, {"", "first of its values in /time_maps"}},
      {"time_map_count", row_number, {"", "number of its values in /time_maps; 0: t = T s/(2 pi)"}},
      {"winding",
       &OrbitRecord::winding,
       {"turns", "net turns of each angle of the root attribute winding_names over the period"},
       RowShape::winding},
      {"verdict",
       &OrbitRecord::verdict,
       {"", "what the certificate says: 0 holds, 1 says nothing, more: a failure; -1: none was computed"},
       RowShape::one,
       certificates_since},
      {"taylor_closure",
       &OrbitRecord::taylor_closure,
       {"scaled state", "closure by Taylor series"},
       RowShape::one,
       certificates_since},
      {"integrators_apart",
       &OrbitRecord::integrators_apart,
       {"scaled state", "largest distance of the ends of the two integrators"},
       RowShape::one,
       certificates_since},
      {"other_drift",
       &OrbitRecord::other_drift,
       {"scaled", "as energy_drift, of the other conserved quantities"},
       RowShape::one,
       certificates_since},
      {"symmetry_defect",
       &OrbitRecord::symmetry_defect,
       {"scaled state", "largest distance of a point of the orbit from where the family's isotropy has it"},
       RowShape::one,
       certificates_since},
      {"recurrence",
       &OrbitRecord::recurrence,
       {"scaled state", "least distance from an orbit gone around several times"},
       RowShape::one,
       certificates_since},
      {"orbit_distance",
       &OrbitRecord::orbit_distance,
       {"scaled state", "estimated distance to the true orbit"},
       RowShape::one,
       certificates_since},
      {"contraction",
       &OrbitRecord::contraction,
       {"", "second step of Newton's method in parts of the first"},
       RowShape::one,
       certificates_since},
      {"pairing",
       &OrbitRecord::pairing,
       {"", "distance of the product of the multipliers from 1"},
       RowShape::one,
       certificates_since},
      {"index_gap",
       &OrbitRecord::index_gap,
       {"", "distance of stability from the certificate's own index"},
       RowShape::one,
       certificates_since},
      {"modes_checksum", checksum, {"", "CRC-32 of the orbit's values in /modes"}},
      {"time_map_checksum", checksum, {"", "CRC-32 of the orbit's values in /time_maps"}},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<CertificateRecord>& certificate_columns() {
  static const ColumnDefinitions<CertificateRecord> columns{
      {"verdict", &CertificateRecord::verdict, {}},
      {"closure", &CertificateRecord::closure, {}},
      {"single_shot", &CertificateRecord::single_shot, {}},
      {"energy_drift", &CertificateRecord::energy_drift, {}},
      {"taylor_closure", &CertificateRecord::taylor_closure, {}},
      {"integrators_apart", &CertificateRecord::integrators_apart, {}},
      {"other_drift", &CertificateRecord::other_drift, {}},
      {"symmetry_defect", &CertificateRecord::symmetry_defect, {}},
      {"recurrence", &CertificateRecord::recurrence, {}},
      {"orbit_distance", &CertificateRecord::orbit_distance, {}},
      {"contraction", &CertificateRecord::contraction, {}},
      {"pairing", &CertificateRecord::pairing, {}},
      {"index_gap", &CertificateRecord::index_gap, {}},
  };
  return columns;
}

const ColumnDefinitions<CrossingRecord>& crossing_columns() {
  static const ColumnDefinitions<CrossingRecord> columns{
      {"family", row_number, {"", "row of /families of the family on which it lies"}},
      {"arclength", &CrossingRecord::arclength, {"", "of the family's orbit there, in the survey's scales"}},
      {"period", &CrossingRecord::period, {"time", "period T"}},
      {"energy", &CrossingRecord::energy, {"energy", "conserved energy; NaN if there is none"}},
      {"parameter",
       &CrossingRecord::parameter,
       {"", "value of the parameter that moves along the families; NaN if none does"},
       RowShape::one,
       parameters_since},
      {"kind",
       &CrossingRecord::kind,
       {"", "branch-point, period-doubling, subharmonic, fold-energy, fold-period, fold-parameter, torus or krein"}},
      {"multiplicity", &CrossingRecord::multiplicity, {"", "m: the orbits born there close after m periods"}},
      {"kernel_dimension",
       &CrossingRecord::kernel_dimension,
       {"", "number of flat directions besides the family's own; -1: not computed"}},
      {"residual", &CrossingRecord::residual, {"", "what is left of zero where it was located"}},
      {"state",
       &CrossingRecord::state,
       {"state", "the orbit there at s = 0, coordinates as in the root attribute state_names"},
       RowShape::state},
      {"sector_j", &CrossingRecord::sector_j, {"", "the multiplier that crosses is exp(2 pi i j/q): j"}},
      {"sector_q", &CrossingRecord::sector_q, {"", "q"}},
      {"fundamental_order", &CrossingRecord::fundamental_order, {"", "p of the fundamental map, over T/p"}},
      {"test_value", &CrossingRecord::test_value, {"", "stability index or multiplier of the fundamental map there"}},
      {"kernel_residual", &CrossingRecord::kernel_residual, {"scaled", "largest singular value that counts as zero"}},
      {"place_error",
       &CrossingRecord::place_error,
       {"", "how far the crossing may lie from there along the family, in arclength"},
       RowShape::one,
       place_errors_since},
      {"place_error_period",
       &CrossingRecord::place_error_period,
       {"time", "what the period changes by over place_error"},
       RowShape::one,
       place_errors_since},
      {"place_error_energy",
       &CrossingRecord::place_error_energy,
       {"energy", "what the energy changes by over place_error; NaN if there is none"},
       RowShape::one,
       place_errors_since},
      {"place_error_parameter",
       &CrossingRecord::place_error_parameter,
       {"", "what the parameter that moves changes by over place_error; NaN if none does"},
       RowShape::one,
       place_errors_since},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<SectionRecord>& section_columns() {
  static const ColumnDefinitions<SectionRecord> columns{
      {"orbit", row_number, {"", "row of /orbits"}},
      {"time", &SectionRecord::time, {"time", "after s = 0"}},
      {"state",
       &SectionRecord::state,
       {"state", "the point, coordinates as in the root attribute state_names"},
       RowShape::state},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<LocusRecord>& locus_columns() {
  static const ColumnDefinitions<LocusRecord> columns{
      {"locus", row_number, {"", "number of the curve"}},
      {"crossing", row_number, {"", "row of /crossings where it begins"}},
      {"family", row_number, {"", "row of /families of that crossing"}},
      {"step", &LocusRecord::step, {"", "0 at the crossing, up to one side and down to the other"}},
      {"arclength", &LocusRecord::arclength, {"", "from the crossing, in the survey's scales"}},
      {"kind", &LocusRecord::kind, {"", "as that of the crossing"}},
      {"period", &LocusRecord::period, {"time", "period T"}},
      {"energy", &LocusRecord::energy, {"energy", "conserved energy; NaN if there is none"}},
      {"parameter",
       &LocusRecord::parameter,
       {"", "value of the parameter that moves along the families; NaN if none does"}},
      {"second_parameter", &LocusRecord::second_parameter, {"", "value of the parameter that the scene frees besides"}},
      {"second_name", &LocusRecord::second_name, {"", "its name"}},
      {"sector_j", &LocusRecord::sector_j, {"", "as that of the crossing"}},
      {"sector_q", &LocusRecord::sector_q, {"", "as that of the crossing"}},
      {"fundamental_order", &LocusRecord::fundamental_order, {"", "as that of the crossing"}},
      {"state",
       &LocusRecord::state,
       {"state", "the orbit there at s = 0, coordinates as in the root attribute state_names"},
       RowShape::state},
      {"note", &LocusRecord::note, {"", "start, cusp, return, or why the curve ends"}},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<EquilibriumRecord>& equilibrium_columns() {
  static const ColumnDefinitions<EquilibriumRecord> columns{
      {"equilibrium", &EquilibriumRecord::equilibrium, {"", "its number, from 0"}},
      {"step",
       &EquilibriumRecord::step,
       {"", "0 at the scene's parameters, up to one side of its curve and down to the other"}},
      {"arclength", &EquilibriumRecord::arclength, {"", "from step 0, in the survey's scales"}},
      {"kind", &EquilibriumRecord::kind, {"", "equilibrium, hopf, fold-parameter, return or branch-point"}},
      {"parameter",
       &EquilibriumRecord::parameter,
       {"", "value of the parameter that moves along the families; NaN if none does"}},
      {"state",
       &EquilibriumRecord::state,
       {"state", "coordinates as in the root attribute state_names"},
       RowShape::state},
      {"energy", &EquilibriumRecord::energy, {"energy", "conserved energy; NaN if there is none"}},
      {"stability",
       &EquilibriumRecord::stability,
       {"", "of the linearised field: elliptic, stable, unstable, neutral or undecided"}},
      {"eigenvalues",
       &EquilibriumRecord::eigenvalues,
       {"1 / time", "re, im of the Jacobian's eigenvalues"},
       RowShape::eigenvalues},
      {"periods",
       &EquilibriumRecord::periods,
       {"time", "2 pi/|im| of the imaginary pairs, longest first; NaN behind the last"},
       RowShape::oscillations},
      {"multiplicity",
       &EquilibriumRecord::multiplicity,
       {"", "how many pairs have that period; -1 behind the last"},
       RowShape::oscillations},
      {"note", &EquilibriumRecord::note, {"", "why the curve ends there"}},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<FindingRecord>& finding_columns() {
  static const ColumnDefinitions<FindingRecord> columns{
      {"severity", &FindingRecord::severity, {"", "contradiction, failure, undecided or cut"}},
      {"kind", &FindingRecord::kind, {"", "what does not add up (docs/file_format.md, /findings)"}},
      {"family", &FindingRecord::family, {"", "row of /families, or -1"}},
      {"other_family", &FindingRecord::other_family, {"", "row of /families, or -1"}},
      {"crossing", &FindingRecord::crossing, {"", "row of /crossings, or -1"}},
      {"period", &FindingRecord::period, {"time", "period T"}},
      {"energy", &FindingRecord::energy, {"energy", "conserved energy; NaN if there is none"}},
      {"parameter",
       &FindingRecord::parameter,
       {"", "value of the parameter that moves along the families; NaN if none does"},
       RowShape::one,
       parameters_since},
      {"deviation", &FindingRecord::deviation, {"", "how far off, as the kind says"}},
      {"text", &FindingRecord::text, {"", "a sentence"}},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<ModelRecord>& model_columns() {
  static const ColumnDefinitions<ModelRecord> columns{
      {"text", &ModelRecord::text, {"", "the model as text (docs/models.md)"}},
      {"checksum", checksum, {"", "CRC-32 of the row (docs/file_format.md, Checksums)"}},
  };
  return columns;
}

const ColumnDefinitions<OrbitRecord>& segment_orbit_columns() {
  static const ColumnDefinitions<OrbitRecord> columns = [] {
    ColumnDefinitions<OrbitRecord> list = orbit_columns();
    list.front() = {"family_key", &OrbitRecord::family_key, {"", "key of the family"}};
    return list;
  }();
  return columns;
}

const ColumnDefinitions<SectionRecord>& segment_section_columns() {
  static const ColumnDefinitions<SectionRecord> columns = [] {
    ColumnDefinitions<SectionRecord> list = section_columns();
    list.front() = {"step", &SectionRecord::step, {"", "of the orbit along its family"}};
    list.insert(list.begin(), {"family_key", &SectionRecord::family_key, {"", "key of the family"}});
    return list;
  }();
  return columns;
}

}  // namespace orbweaver::archive
