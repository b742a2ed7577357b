# How this project's own programs are built: warnings, sanitizers, tuning. Users of the library
# get none of this.

option(RCO_WERROR "Treat warnings in this project's own programs as errors" OFF)
option(RCO_NATIVE "Compile the benchmarks for this machine's processor (-march=native)" OFF)
option(RCO_TEST_ASSERTIONS
  "Keep the assertions of CGAL, Eigen and this package in the tests, in Release too" OFF)
set(RCO_SANITIZERS "" CACHE STRING
  "Comma-separated sanitizers for this project's own programs, such as address,undefined")

add_library(rco_settings INTERFACE)
target_link_libraries(rco_settings INTERFACE
  Reference_constrained_optimization::Reference_constrained_optimization)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(rco_settings INTERFACE -Wall -Wextra)
  # gcc 12 takes "text" + std::string in C++20 for overlapping copies
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(rco_settings INTERFACE -Wno-restrict)
  endif()
  if(RCO_WERROR)
    target_compile_options(rco_settings INTERFACE -Werror)
  endif()
  if(RCO_SANITIZERS)
    target_compile_options(rco_settings INTERFACE
      -fsanitize=${RCO_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
    target_link_options(rco_settings INTERFACE -fsanitize=${RCO_SANITIZERS})
  endif()
elseif(MSVC)
  target_compile_options(rco_settings INTERFACE /W3)
  if(RCO_WERROR)
    target_compile_options(rco_settings INTERFACE /WX)
  endif()
endif()

# rco_add_executable([<folder>/]<name>) builds <name>.cpp, of the current folder or one below it. A
# source that is not there yet is no error: the caller sees it by the target's absence.
function(rco_add_executable path)
  if(NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${path}.cpp")
    message(STATUS "${path}: no source file yet, skipped")
    return()
  endif()
  get_filename_component(name ${path} NAME)
  add_executable(${name} ${path}.cpp)
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF)
  target_link_libraries(${name} PRIVATE rco_settings)
  # the folder of CGAL's *.off files, and for CGAL::data_file_path() the folder above it
  get_filename_component(cgal_data_dir "${RCO_DATA_DIR}" DIRECTORY)
  target_compile_definitions(${name} PRIVATE
    RCO_DATA_DIR="${RCO_DATA_DIR}"
    CGAL_DATA_DIR="${cgal_data_dir}")
endfunction()
