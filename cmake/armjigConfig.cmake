# SPDX-License-Identifier: Apache-2.0
# find_package(armjig) gives
#
# - of the embeddable part: armjig::wire, armjig::arm, armjig::motion, armjig::emulators,
#   armjig::memory, armjig::capture, armjig::replay;
# - of the whole, where it is installed: armjig::harness, armjig::conformance, armjig::cli and the
#   other rooms of docs/architecture.md. find_package(armjig COMPONENTS whole) demands it.
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(tl-expected)
include(${CMAKE_CURRENT_LIST_DIR}/armjigEmbeddedTargets.cmake)
if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/armjigTargets.cmake)
  find_dependency(Threads)
  include(${CMAKE_CURRENT_LIST_DIR}/armjigTargets.cmake)
  set(armjig_whole_FOUND TRUE)
endif()
set(armjig_embedded_FOUND TRUE)
foreach(component IN LISTS armjig_FIND_COMPONENTS)
  if(armjig_FIND_REQUIRED_${component} AND NOT armjig_${component}_FOUND)
    set(armjig_FOUND FALSE)
    set(armjig_NOT_FOUND_MESSAGE "there is no component '${component}' of armjig here")
  endif()
endforeach()
