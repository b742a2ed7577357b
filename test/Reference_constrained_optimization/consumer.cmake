# The ways to use the package from outside, each with the same small program: installed and found,
# as a part of another project, and by the include path alone.

# where this build found its dependencies
set(locations "")
foreach(variable CGAL_DIR Eigen3_DIR EIGEN3_INCLUDE_DIR TBB_DIR Boost_DIR CMAKE_CXX_STANDARD)
  if(${variable})
    list(APPEND locations "-D${variable}=${${variable}}")
  endif()
endforeach()
string(REPLACE ";" "|" locations "${locations}")
set(include_dirs
  "$<JOIN:$<TARGET_PROPERTY:CGAL::CGAL,INTERFACE_INCLUDE_DIRECTORIES>;$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>,|>")

foreach(way installed subdirectory include_path)
  if(way STREQUAL "installed" AND NOT RCO_INSTALL)
    continue()
  endif()
  # the other two ask CMake for everything; this one needs to know how compilers are called
  if(way STREQUAL "include_path" AND NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    continue()
  endif()
  add_test(NAME use_${way}
    COMMAND "${CMAKE_COMMAND}" -D WAY=${way}
      -D "SOURCE=${PROJECT_SOURCE_DIR}" -D "BUILD=${PROJECT_BINARY_DIR}"
      -D "WORK=${CMAKE_CURRENT_BINARY_DIR}/use_${way}"
      -D "COMPILER=${CMAKE_CXX_COMPILER}" -D "COMPILER_FLAGS=${CMAKE_CXX_FLAGS}"
      -D "GENERATOR=${CMAKE_GENERATOR}" -D "LOCATIONS=${locations}"
      -D "INCLUDE_DIRS=${include_dirs}" -D "LIBRARIES=-lmpfr|-lgmp"
      -P "${CMAKE_CURRENT_SOURCE_DIR}/consumer/consume.cmake")
  set_tests_properties(use_${way} PROPERTIES LABELS default TIMEOUT 1500)
endforeach()
