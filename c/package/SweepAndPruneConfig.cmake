# Targets: SweepAndPrune::shared and SweepAndPrune::static.
get_filename_component(_sap_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET SweepAndPrune::shared)
  add_library(SweepAndPrune::shared SHARED IMPORTED)
  set_target_properties(SweepAndPrune::shared PROPERTIES
    IMPORTED_LOCATION "${_sap_prefix}/lib/libsweep_and_prune.so"
    IMPORTED_SONAME "@SONAME@"
    INTERFACE_INCLUDE_DIRECTORIES "${_sap_prefix}/include")

  add_library(SweepAndPrune::static STATIC IMPORTED)
  set_target_properties(SweepAndPrune::static PROPERTIES
    IMPORTED_LOCATION "${_sap_prefix}/lib/libsweep_and_prune.a"
    IMPORTED_LINK_INTERFACE_LANGUAGES C
    INTERFACE_LINK_LIBRARIES "pthread;m;dl;gcc_s"
    INTERFACE_INCLUDE_DIRECTORIES "${_sap_prefix}/include")
endif()
unset(_sap_prefix)
