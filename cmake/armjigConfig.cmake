# SPDX-License-Identifier: Apache-2.0
# find_package(armjig): targets armjig::wire, armjig::arm, armjig::motion, armjig::urdf,
# armjig::emulators, armjig::capture, armjig::replay and, unless the build left them out,
# armjig::harness, armjig::script, armjig::host, armjig::conformance.
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(tl-expected)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/armjigTargets.cmake)
