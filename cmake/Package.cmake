# `cmake --install` and find_package(Orbweaver): a target Orbweaver::<layer> for each layer, with the public headers.
include(CMakePackageConfigHelpers)
set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/Orbweaver")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/orbweaver" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")
install(EXPORT OrbweaverTargets NAMESPACE Orbweaver:: DESTINATION "${package_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/OrbweaverConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_LIST_DIR}/OrbweaverConfig.cmake" "${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake"
  "${PROJECT_BINARY_DIR}/OrbweaverConfigVersion.cmake" DESTINATION "${package_folder}")
