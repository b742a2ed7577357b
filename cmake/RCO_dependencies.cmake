# Finds what the headers need. Included by this project's CMakeLists.txt and, once installed, by
# its package configuration file.
#
#   rco_find_dependencies(<variable> WITH_TBB <ON|OFF>)
#
# ends with the targets CGAL::CGAL, CGAL::Eigen3_support and Eigen3::Eigen, and with
# CGAL::TBB_support if TBB is wanted and found. <variable> holds a sentence on the first thing that
# is missing, or nothing. It is a macro, so that the packages' own variables reach the caller.

# a target imported here is seen in this directory and below; a project that includes ours with
# add_subdirectory() must see it too. Targets found earlier, elsewhere, are left as they are.
macro(_rco_make_global)
  foreach(_rco_target ${ARGN})
    if(TARGET ${_rco_target} AND NOT ${_rco_target} IN_LIST _rco_known_targets)
      get_target_property(_rco_imported ${_rco_target} IMPORTED)
      get_target_property(_rco_alias ${_rco_target} ALIASED_TARGET)
      if(_rco_imported AND NOT _rco_alias)
        set_target_properties(${_rco_target} PROPERTIES IMPORTED_GLOBAL TRUE)
      endif()
    endif()
  endforeach()
endmacro()

macro(rco_find_dependencies _rco_missing _rco_with_tbb_key _rco_with_tbb)
  set(${_rco_missing} "")
  set(_rco_promoted_targets Eigen3::Eigen CGAL::Eigen3_support TBB::tbb TBB::tbbmalloc
    CGAL::TBB_support Threads::Threads)
  set(_rco_known_targets "")
  foreach(_rco_target ${_rco_promoted_targets})
    if(TARGET ${_rco_target})
      list(APPEND _rco_known_targets ${_rco_target})
    endif()
  endforeach()

  # Eigen comes before CGAL: find_package(CGAL) puts a FindEigen3.cmake on the module path that
  # knows no Eigen3::Eigen. No version is asked for: Eigen 3.x and 5.x both refuse the other's.
  find_package(Eigen3 CONFIG QUIET)
  if(TARGET Eigen3::Eigen)
    # CGAL 5.x looks at the old spelling, which Eigen 5 no longer sets
    set(EIGEN3_FOUND TRUE)
  else()
    find_package(Eigen3 QUIET)
    if(EIGEN3_INCLUDE_DIR)
      set(EIGEN3_FOUND TRUE)
      add_library(Eigen3::Eigen INTERFACE IMPORTED)
      set_target_properties(Eigen3::Eigen PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${EIGEN3_INCLUDE_DIR}")
    endif()
  endif()

  # CGAL 5.x and 6.x refuse each other's version too, so the check is ours
  find_package(CGAL QUIET)

  if(NOT TARGET CGAL::CGAL)
    set(${_rco_missing} "CGAL (5.5 or later) was not found.")
  elseif(CGAL_VERSION AND CGAL_VERSION VERSION_LESS 5.5)
    set(${_rco_missing} "CGAL 5.5 or later is needed, but CGAL ${CGAL_VERSION} was found.")
  elseif(NOT TARGET Eigen3::Eigen)
    set(${_rco_missing} "Eigen (3.3.7 or later) was not found.")
  else()
    include(CGAL_Eigen3_support)
    if(NOT TARGET CGAL::Eigen3_support)
      set(${_rco_missing} "CGAL refuses the Eigen that was found (${Eigen3_DIR}).")
    endif()
  endif()

  if("${${_rco_missing}}" STREQUAL "" AND ${_rco_with_tbb})
    # config mode: CGAL's FindTBB.cmake is for the time before oneTBB
    find_package(TBB CONFIG QUIET)
    if(TARGET TBB::tbb AND TARGET TBB::tbbmalloc)
      include(CGAL_TBB_support)
    endif()
  endif()

  _rco_make_global(${_rco_promoted_targets})
endmacro()
