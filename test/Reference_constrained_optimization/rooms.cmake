# Checks that the internal headers lie in rooms that include downwards only: each header those of its own
# room and of the rooms before it; and that each room has a test with its name.
#
#   cmake -D SOURCE=<root of the project> -P rooms.cmake

cmake_minimum_required(VERSION 3.21)

# from the bottom to the top
set(rooms
    support # threads, interruption, clocks, text, versions of CGAL
    mesh # mesh and points as arrays, quantities of shape
    numerics # linear systems, Newton's method
    reference # the reference surface, its lines and features
    objective # the energy's elements and the barriers
    state # the mesh on its reference, and patches of it
    reading # from the user's meshes to the state
    selection # which faces make a patch, which patches a round
    shape # distances and normal deviations from the reference
    invariants # what no accepted step does
    flattening # movers: flattened patches
    on_surface # movers: steps on the surface, search, clusters
    rounds # accept and commit
    stages # iterate, repair the worst, finish
    writing # from the state to the user's mesh
    landmark_map) # initial maps from landmarks

set(prefix CGAL/Reference_constrained_optimization/internal)
file(GLOB places RELATIVE "${SOURCE}/include/${prefix}" "${SOURCE}/include/${prefix}/*")
foreach(place IN LISTS places)
  if(IS_DIRECTORY "${SOURCE}/include/${prefix}/${place}" AND NOT place IN_LIST rooms)
    message(SEND_ERROR "internal/${place} is not in the order of the rooms (rooms.cmake)")
  endif()
endforeach()

foreach(room IN LISTS rooms)
  list(FIND rooms ${room} floor)
  file(GLOB headers "${SOURCE}/include/${prefix}/${room}/*.h")
  if(NOT headers)
    message(SEND_ERROR "internal/${room} is empty (rooms.cmake)")
  endif()
  if(NOT EXISTS "${CMAKE_CURRENT_LIST_DIR}/test_${room}.cpp")
    message(SEND_ERROR "internal/${room} has no test_${room}.cpp")
  endif()
  foreach(header IN LISTS headers)
    get_filename_component(name "${header}" NAME)
    file(STRINGS "${header}" lines REGEX "^#include <${prefix}/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include <${prefix}/([^>]*)>.*" "\\1" included "${line}")
      string(REGEX REPLACE "/.*" "" other "${included}")
      list(FIND rooms "${other}" other_floor)
      if(other_floor LESS 0 OR other_floor GREATER floor)
        message(SEND_ERROR "${room}/${name} includes ${included}, which is above it")
      endif()
    endforeach()
  endforeach()
endforeach()
