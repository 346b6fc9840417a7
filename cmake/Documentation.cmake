# Target `docs`: the reference of the C++ interface from the public headers' comments, where Doxygen is installed. A warning, such as
# of a reference that leads nowhere, is an error (test structure_doxygen).
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  message(STATUS "Doxygen not found: no target docs")
  return()
endif()
set(DOXYGEN_PROJECT_NAME "Orbweaver")
set(DOXYGEN_PROJECT_NUMBER "${PROJECT_VERSION}")
set(DOXYGEN_PROJECT_BRIEF "${PROJECT_DESCRIPTION}")
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/api")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}/include")
set(DOXYGEN_STRIP_FROM_INC_PATH "${PROJECT_SOURCE_DIR}/include")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/docs/api.md")
# Declarations of code that is Eigen's.
set(DOXYGEN_EXCLUDE "${PROJECT_SOURCE_DIR}/include/orbweaver/numerics/decompositions.hpp")
set(DOXYGEN_EXCLUDE_SYMBOLS "detail" "*::detail")
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
# Names say what is obvious; what is wrong is not let through.
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
set(DOXYGEN_WARN_NO_PARAMDOC NO)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(docs "${PROJECT_SOURCE_DIR}/include/orbweaver" "${PROJECT_SOURCE_DIR}/docs/api.md"
  COMMENT "The reference of the C++ interface: ${DOXYGEN_OUTPUT_DIRECTORY}/html/index.html")
