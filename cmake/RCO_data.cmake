# Sets RCO_DATA_DIR, the folder that holds CGAL's example meshes (blobby.off, armadillo.off, ...).
# In this order: what the user says; the archive that Debian ships with libcgal-demo, unpacked into
# the build folder; the data folder of a CGAL source tree. If there is none, programs are built all
# the same, example runs are left out and tests that want a mesh from it skip that part.

set(RCO_DATA_ARCHIVE "/usr/share/doc/libcgal-dev/data.tar.gz" CACHE FILEPATH
  "Archive of CGAL's data (its meshes are in data/meshes)")
set(RCO_DATA_DIR "${CMAKE_BINARY_DIR}/data/meshes" CACHE PATH "Folder of CGAL's *.off meshes")

function(rco_unpack_data)
  if(EXISTS "${RCO_DATA_DIR}" OR NOT EXISTS "${RCO_DATA_ARCHIVE}")
    return()
  endif()
  if(NOT RCO_DATA_DIR STREQUAL "${CMAKE_BINARY_DIR}/data/meshes")
    return()
  endif()
  # unpacked aside, then renamed: an interrupted configuration leaves no half-filled folder
  set(staging "${CMAKE_BINARY_DIR}/data.part")
  file(REMOVE_RECURSE "${staging}")
  file(MAKE_DIRECTORY "${staging}")
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -E tar xzf "${RCO_DATA_ARCHIVE}" data/meshes
    WORKING_DIRECTORY "${staging}"
    RESULT_VARIABLE failed)
  if(NOT failed AND EXISTS "${staging}/data/meshes")
    file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/data")
    file(RENAME "${staging}/data/meshes" "${RCO_DATA_DIR}")
  else()
    message(WARNING "${RCO_DATA_ARCHIVE} could not be unpacked, or has no folder data/meshes")
  endif()
  file(REMOVE_RECURSE "${staging}")
endfunction()
rco_unpack_data()

if(NOT EXISTS "${RCO_DATA_DIR}" AND CGAL_DATA_DIR AND EXISTS "${CGAL_DATA_DIR}/meshes")
  set(RCO_DATA_DIR "${CGAL_DATA_DIR}/meshes" CACHE PATH "Folder of CGAL's *.off meshes" FORCE)
endif()
if(EXISTS "${RCO_DATA_DIR}")
  message(STATUS "CGAL's meshes: ${RCO_DATA_DIR}")
else()
  message(STATUS "CGAL's meshes were not found (Debian: libcgal-demo; or set RCO_DATA_DIR)")
endif()
