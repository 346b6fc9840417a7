# `cmake --install` and find_package(Orbweaver): a target Orbweaver::<layer> for each layer, with the public headers. Two components:
# `program`, and `development`, all that does not say otherwise.
include(CMakePackageConfigHelpers)
set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/Orbweaver")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/orbweaver" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/drivers/scenes/" DESTINATION "${CMAKE_INSTALL_DATADIR}/orbweaver/scenes" COMPONENT program
  FILES_MATCHING PATTERN "*.yaml")
install(FILES "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/CITATION.cff"
  DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
install(EXPORT OrbweaverTargets NAMESPACE Orbweaver:: DESTINATION "${package_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/OrbweaverConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_LIST_DIR}/OrbweaverConfig.cmake" "${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake"
  "${PROJECT_BINARY_DIR}/OrbweaverConfigVersion.cmake" DESTINATION "${package_folder}")
