# The targets of the layers name those of the packages below them. FindMPI looks for the C library by compiling C.
enable_language(C)
include("${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/OrbweaverTargets.cmake")
