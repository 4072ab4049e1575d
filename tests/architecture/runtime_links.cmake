# SPDX-License-Identifier: AGPL-3.0-or-later
# A program of the runtime (body, raycast, haptics, echo, operators, session) loads no library of meshing, command
# lines or windows. The tool, which needs them all, shows that the check sees them.
cmake_minimum_required(VERSION 3.25)
set(foreign "lib(gmp|mpfr|CGAL|tet|glfw|imgui|epoxy|GL|OpenGL)[-.0-9]")
function(find_foreign program result)
  execute_process(COMMAND objdump -p ${program} OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "NEEDED +[^\n]+" needed "${out}")
  list(FILTER needed INCLUDE REGEX "${foreign}")
  set(${result} "${needed}" PARENT_SCOPE)
endfunction()
find_foreign(${TOOL} seen)
if(NOT seen MATCHES "libtet" OR NOT seen MATCHES "libglfw")
  message(FATAL_ERROR "the check does not see the libraries of the tool: ${seen}")
endif()
find_foreign(${RUNTIME} seen)
if(seen)
  message(FATAL_ERROR "${RUNTIME} loads what the runtime must not: ${seen}")
endif()
