# Targets of the folder that `cargo xtask dist-c` makes:
#
#   darboux::darboux            darboux.h and darboux.hpp, the shared library
#   darboux::darboux_static     the same, the static library
#   darboux::mikktspace         mikktspace.h in place of mikktspace.c, the shared library
#   darboux::mikktspace_static  the same, the static library

get_filename_component(_darboux_folder "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

if(APPLE)
  set(_darboux_system)
else()
  set(_darboux_system gcc_s pthread m dl)
endif()

function(_darboux_add_library name library headers)
  if(TARGET darboux::${name})
    return()
  endif()
  add_library(darboux::${name} SHARED IMPORTED)
  add_library(darboux::${name}_static STATIC IMPORTED)
  set_target_properties(darboux::${name} darboux::${name}_static PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${_darboux_folder}/${headers}")
  set(start "${_darboux_folder}/lib/lib${library}")
  set_target_properties(darboux::${name} PROPERTIES
    IMPORTED_LOCATION "${start}${CMAKE_SHARED_LIBRARY_SUFFIX}")
  set_target_properties(darboux::${name}_static PROPERTIES
    IMPORTED_LOCATION "${start}${CMAKE_STATIC_LIBRARY_SUFFIX}"
    INTERFACE_LINK_LIBRARIES "${_darboux_system}")
endfunction()

_darboux_add_library(darboux darboux include)
_darboux_add_library(mikktspace darboux_mikktspace include/mikktspace)
