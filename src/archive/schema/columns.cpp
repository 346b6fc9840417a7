#include "columns.hpp"

namespace orbweaver::archive {

namespace {

constexpr RowNumber row_number{};
constexpr Checksum checksum{};

}  // namespace

const ColumnDefinitions<FamilyRecord>& family_columns() {
  static const ColumnDefinitions<FamilyRecord> columns{
      {"name", &FamilyRecord::name},
      {"parent", row_number},
      {"crossing", row_number},
      {"multiplicity", &FamilyRecord::multiplicity},
      {"isotropy", &FamilyRecord::isotropy},
      {"first_orbit", row_number},
      {"orbit_count", row_number},
      {"end_reason", &FamilyRecord::end_reason},
      {"end_family", row_number},
      {"end_crossing", row_number},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<OrbitRecord>& orbit_columns() {
  static const ColumnDefinitions<OrbitRecord> columns{
      {"family", row_number},
      {"step", &OrbitRecord::step},
      {"arclength", &OrbitRecord::arclength},
      {"period", &OrbitRecord::period},
      {"energy", &OrbitRecord::energy},
      {"action", &OrbitRecord::action},
      {"parameter", &OrbitRecord::parameter},
      {"cutoff", &OrbitRecord::cutoff},
      {"loss_rms", &OrbitRecord::loss_rms},
      {"off_branch_eigenvalue", &OrbitRecord::off_branch_eigenvalue},
      {"stability", &OrbitRecord::stability, RowShape::stability},
      {"fundamental_stability", &OrbitRecord::fundamental_stability, RowShape::stability},
      {"stability_error", &OrbitRecord::stability_error},
      {"log_volume", &OrbitRecord::log_volume, RowShape::one, volumes_since},
      {"state", &OrbitRecord::state, RowShape::state},
      {"closure", &OrbitRecord::closure},
      {"single_shot", &OrbitRecord::single_shot},
      {"energy_drift", &OrbitRecord::energy_drift},
      {"tail", &OrbitRecord::tail},
      {"modes_begin", row_number},
      {"modes_count", row_number},
      {"time_map_begin", row_number},
      {"time_map_count", row_number},
      {"winding", &OrbitRecord::winding, RowShape::winding},
      {"verdict", &OrbitRecord::verdict, RowShape::one, certificates_since},
      {"taylor_closure", &OrbitRecord::taylor_closure, RowShape::one, certificates_since},
      {"integrators_apart", &OrbitRecord::integrators_apart, RowShape::one, certificates_since},
      {"other_drift", &OrbitRecord::other_drift, RowShape::one, certificates_since},
      {"symmetry_defect", &OrbitRecord::symmetry_defect, RowShape::one, certificates_since},
      {"recurrence", &OrbitRecord::recurrence, RowShape::one, certificates_since},
      {"orbit_distance", &OrbitRecord::orbit_distance, RowShape::one, certificates_since},
      {"contraction", &OrbitRecord::contraction, RowShape::one, certificates_since},
      {"pairing", &OrbitRecord::pairing, RowShape::one, certificates_since},
      {"index_gap", &OrbitRecord::index_gap, RowShape::one, certificates_since},
      {"modes_checksum", checksum},
      {"time_map_checksum", checksum},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<CertificateRecord>& certificate_columns() {
  static const ColumnDefinitions<CertificateRecord> columns{
      {"verdict", &CertificateRecord::verdict},
      {"closure", &CertificateRecord::closure},
      {"single_shot", &CertificateRecord::single_shot},
      {"energy_drift", &CertificateRecord::energy_drift},
      {"taylor_closure", &CertificateRecord::taylor_closure},
      {"integrators_apart", &CertificateRecord::integrators_apart},
      {"other_drift", &CertificateRecord::other_drift},
      {"symmetry_defect", &CertificateRecord::symmetry_defect},
      {"recurrence", &CertificateRecord::recurrence},
      {"orbit_distance", &CertificateRecord::orbit_distance},
      {"contraction", &CertificateRecord::contraction},
      {"pairing", &CertificateRecord::pairing},
      {"index_gap", &CertificateRecord::index_gap},
  };
  return columns;
}

const ColumnDefinitions<CrossingRecord>& crossing_columns() {
  static const ColumnDefinitions<CrossingRecord> columns{
      {"family", row_number},
      {"arclength", &CrossingRecord::arclength},
      {"period", &CrossingRecord::period},
      {"energy", &CrossingRecord::energy},
      {"parameter", &CrossingRecord::parameter, RowShape::one, parameters_since},
      {"kind", &CrossingRecord::kind},
      {"multiplicity", &CrossingRecord::multiplicity},
      {"kernel_dimension", &CrossingRecord::kernel_dimension},
      {"residual", &CrossingRecord::residual},
      {"state", &CrossingRecord::state, RowShape::state},
      {"sector_j", &CrossingRecord::sector_j},
      {"sector_q", &CrossingRecord::sector_q},
      {"fundamental_order", &CrossingRecord::fundamental_order},
      {"test_value", &CrossingRecord::test_value},
      {"kernel_residual", &CrossingRecord::kernel_residual},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<SectionRecord>& section_columns() {
  static const ColumnDefinitions<SectionRecord> columns{
      {"orbit", row_number},
      {"time", &SectionRecord::time},
      {"state", &SectionRecord::state, RowShape::state},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<LocusRecord>& locus_columns() {
  static const ColumnDefinitions<LocusRecord> columns{
      {"locus", row_number},
      {"crossing", row_number},
      {"family", row_number},
      {"step", &LocusRecord::step},
      {"arclength", &LocusRecord::arclength},
      {"kind", &LocusRecord::kind},
      {"period", &LocusRecord::period},
      {"energy", &LocusRecord::energy},
      {"parameter", &LocusRecord::parameter},
      {"second_parameter", &LocusRecord::second_parameter},
      {"second_name", &LocusRecord::second_name},
      {"sector_j", &LocusRecord::sector_j},
      {"sector_q", &LocusRecord::sector_q},
      {"fundamental_order", &LocusRecord::fundamental_order},
      {"state", &LocusRecord::state, RowShape::state},
      {"note", &LocusRecord::note},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<EquilibriumRecord>& equilibrium_columns() {
  static const ColumnDefinitions<EquilibriumRecord> columns{
      {"equilibrium", &EquilibriumRecord::equilibrium},
      {"step", &EquilibriumRecord::step},
      {"arclength", &EquilibriumRecord::arclength},
      {"kind", &EquilibriumRecord::kind},
      {"parameter", &EquilibriumRecord::parameter},
      {"state", &EquilibriumRecord::state, RowShape::state},
      {"energy", &EquilibriumRecord::energy},
      {"stability", &EquilibriumRecord::stability},
      {"eigenvalues", &EquilibriumRecord::eigenvalues, RowShape::eigenvalues},
      {"periods", &EquilibriumRecord::periods, RowShape::oscillations},
      {"multiplicity", &EquilibriumRecord::multiplicity, RowShape::oscillations},
      {"note", &EquilibriumRecord::note},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<FindingRecord>& finding_columns() {
  static const ColumnDefinitions<FindingRecord> columns{
      {"severity", &FindingRecord::severity},
      {"kind", &FindingRecord::kind},
      {"family", &FindingRecord::family},
      {"other_family", &FindingRecord::other_family},
      {"crossing", &FindingRecord::crossing},
      {"period", &FindingRecord::period},
      {"energy", &FindingRecord::energy},
      {"parameter", &FindingRecord::parameter, RowShape::one, parameters_since},
      {"deviation", &FindingRecord::deviation},
      {"text", &FindingRecord::text},
      {"checksum", checksum},
  };
  return columns;
}

const ColumnDefinitions<OrbitRecord>& segment_orbit_columns() {
  static const ColumnDefinitions<OrbitRecord> columns = [] {
    ColumnDefinitions<OrbitRecord> list = orbit_columns();
    list.front() = {"family_key", &OrbitRecord::family_key};
    return list;
  }();
  return columns;
}

const ColumnDefinitions<SectionRecord>& segment_section_columns() {
  static const ColumnDefinitions<SectionRecord> columns = [] {
    ColumnDefinitions<SectionRecord> list = section_columns();
    list.front() = {"step", &SectionRecord::step};
    list.insert(list.begin(), {"family_key", &SectionRecord::family_key});
    return list;
  }();
  return columns;
}

}  // namespace orbweaver::archive
