# Debian packages by CPack (docs/packaging.md): orbweaver, the program, and orbweaver-dev, the libraries and
# headers for find_package(Orbweaver). The preset `package` compiles what they are to hold.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME orbweaver)
set(CPACK_PACKAGE_VENDOR "The Orbweaver developers")
set(CPACK_PACKAGE_CONTACT "The Orbweaver developers <orbweaver@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Copyright, changelog, and what Debian wants compressed.
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/debian_documents.cmake")
set(CPACK_ORBWEAVER_SOURCE_DIR "${PROJECT_SOURCE_DIR}")
set(CPACK_ORBWEAVER_BUILD_DIR "${PROJECT_BINARY_DIR}")

# What the program loads comes from dpkg-shlibdeps; mpirun and gnuplot it starts.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME orbweaver)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "openmpi-bin")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox, libopenblas0-serial")
set(processor "any processor of this kind")
if(ORBWEAVER_NATIVE)
  set(processor "the machine that made the package and its like")
elseif(ORBWEAVER_BASELINE)
  set(processor "processors from ${ORBWEAVER_BASELINE} on")
endif()
# Behind the project's own line.
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Orbweaver finds the equilibria of a dynamical system and the small
oscillations around them, continues each into a family of periodic orbits,
follows the families that cross it, and leaves everything in one HDF5 file:
alone, or on many MPI ranks.
.
Compiled for ${processor}.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME orbweaver-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# As `quickstart` installs them, without the tools.
set(packages libopenmpi-dev petsc-dev slepc-dev libpetsc-real-dev libslepc-real-dev libhdf5-openmpi-dev libboost-dev
  libboost-serialization-dev libeigen3-dev libfftw3-dev libflint-arb-dev libgmp-dev libmpfr-dev libfmt-dev libspdlog-dev
  libyaml-cpp-dev libcli11-dev zlib1g-dev pkg-config)
list(JOIN packages ", " packages)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "orbweaver (= ${PROJECT_VERSION}), ${packages}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake, g++")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The static libraries of Orbweaver and their headers, a target Orbweaver::LAYER
for each of its layers, for programs that find_package(Orbweaver).")
include(CPack)

# The section of CHANGELOG.md about this version, as a file of its own.
add_custom_target(release_notes ${CMAKE_COMMAND} "-DCHANGELOG=${PROJECT_SOURCE_DIR}/CHANGELOG.md" "-DVERSION=${PROJECT_VERSION}"
  "-DOUT=${PROJECT_BINARY_DIR}/release_notes.md" -P "${CMAKE_CURRENT_LIST_DIR}/release_notes.cmake" VERBATIM)
