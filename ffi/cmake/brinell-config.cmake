# find_package(brinell), then target_link_libraries(program PRIVATE brinell::brinell).
get_filename_component(_brinell_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET brinell::brinell)
  add_library(brinell::brinell SHARED IMPORTED)
  set_target_properties(brinell::brinell PROPERTIES
    IMPORTED_LOCATION "${_brinell_prefix}/lib/libbrinell.so.0"
    IMPORTED_SONAME "libbrinell.so.0"
    INTERFACE_INCLUDE_DIRECTORIES "${_brinell_prefix}/include")
endif()
unset(_brinell_prefix)
