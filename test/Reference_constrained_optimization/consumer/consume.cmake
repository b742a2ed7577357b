# Builds the consumer's program in one of three ways and runs it. Variables:
#   WAY           installed, subdirectory or include_path
#   SOURCE        the package's source tree
#   BUILD         its build folder (installed)
#   WORK          a folder to work in
#   COMPILER      the C++ compiler, and COMPILER_FLAGS
#   GENERATOR     of CMake; LOCATIONS: options that tell where the dependencies are
#   INCLUDE_DIRS  those of CGAL and Eigen (include_path), and LIBRARIES to link
# Lists are separated by |.
cmake_minimum_required(VERSION 3.16)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(result)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

foreach(list LOCATIONS INCLUDE_DIRS LIBRARIES)
  string(REPLACE "|" ";" ${list} "${${list}}")
endforeach()
separate_arguments(COMPILER_FLAGS UNIX_COMMAND "${COMPILER_FLAGS}")
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
set(consumer "${CMAKE_CURRENT_LIST_DIR}")

if(WAY STREQUAL "include_path")
  set(include_options "-I${SOURCE}/include")
  foreach(folder ${INCLUDE_DIRS})
    list(APPEND include_options "-I${folder}")
  endforeach()
  # no optimization: it would take most of the time
  run("${COMPILER}" -std=c++17 -O0 -DNDEBUG -DCGAL_EIGEN3_ENABLED ${COMPILER_FLAGS}
    ${include_options} "${consumer}/consumer.cpp" -o "${WORK}/consumer" ${LIBRARIES})
  run("${WORK}/consumer")
  return()
endif()

if(WAY STREQUAL "installed")
  run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/prefix")
  # as many headers as there are
  file(GLOB_RECURSE headers RELATIVE "${SOURCE}/include" "${SOURCE}/include/*.h")
  foreach(header ${headers})
    if(NOT EXISTS "${WORK}/prefix/include/${header}")
      message(FATAL_ERROR "${header} was not installed")
    endif()
  endforeach()
  set(from "-DCMAKE_PREFIX_PATH=${WORK}/prefix")
else()
  set(from "-DRCO_SOURCE=${SOURCE}")
endif()
run("${CMAKE_COMMAND}" -S "${consumer}" -B "${WORK}/build" -G "${GENERATOR}"
  "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${COMPILER_FLAGS}"
  -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG" ${LOCATIONS} "${from}")
run("${CMAKE_COMMAND}" --build "${WORK}/build")
run("${WORK}/build/consumer")

# what is written about a package must be true: it was found where it was put
if(WAY STREQUAL "installed")
  file(STRINGS "${WORK}/build/CMakeCache.txt" found REGEX "^Reference_constrained_optimization_DIR:")
  string(FIND "${found}" "${WORK}/prefix/" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "another installation was found: ${found}")
  endif()
endif()
