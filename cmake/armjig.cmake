# SPDX-License-Identifier: Apache-2.0
# How every library of this project is built. Nothing here is exported.

set(CMAKE_CXX_EXTENSIONS OFF)

add_library(armjig_flags INTERFACE)
target_compile_features(armjig_flags INTERFACE cxx_std_20)
target_compile_options(armjig_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       # What an initialiser leaves out has its default on purpose.
                       -Wno-missing-field-initializers
                       # GCC 12 sees overlaps and uninitialised bytes in std::string that are not
                       # there (its bugs 105651 and 105562); Clang watches for real ones.
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-maybe-uninitialized>
                       # std::stable_sort of libstdc++ 12 calls what is deprecated.
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
                       $<$<BOOL:${ARMJIG_WERROR}>:-Werror>)

find_program(ARMJIG_CCACHE ccache)
if(ARMJIG_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ARMJIG_CCACHE})
endif()

# armjig_unite(TARGET): with ARMJIG_UNITE its sources are compiled twenty at a time, neighbours in the
# tree, which takes a quarter of the time. So what files keep to themselves in one namespace has
# names of its own.
function(armjig_unite target)
  if(NOT ARMJIG_UNITE)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(SORT sources)
  set(number 0)
  foreach(source IN LISTS sources)
    math(EXPR score "${number} / 20")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP score_${score})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

# Compiles into the library armjig_NAME where requirements stand in docs/spec (document_lines.cmake).
function(armjig_document_lines name)
  file(GLOB documents CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
       ${PROJECT_SOURCE_DIR}/docs/spec/*.md)
  set(script ${PROJECT_SOURCE_DIR}/cmake/document_lines.cmake)
  set(table ${PROJECT_BINARY_DIR}/document_lines.cpp)
  add_custom_command(OUTPUT ${table}
                     COMMAND ${CMAKE_COMMAND} -D TABLE=${table} -P ${script} ${documents}
                     DEPENDS ${documents} ${script}
                     WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
  target_sources(armjig_${name} PRIVATE ${table})
endfunction()

# armjig_library(NAME SOURCES folder... [ONLY name... | EXCEPT name...] [INSTALLED header...]
#                [EMBEDDABLE] [EXACT_FLOATS] [PUBLIC target...] [PRIVATE target...] [HEADERS_OF target...])
#
# The library armjig_NAME, exported as armjig::NAME, of all sources and headers in those folders, or
# of those among them that are called so (without .cpp and .hpp), or not called so. All headers are
# installed, or those of INSTALLED (without .hpp), which include no others. EMBEDDABLE puts
# it into the package that needs neither Boost nor an operating system (component embedded), else it
# is in the whole (component dev).
# Headers are included from the root of the tree. EXACT_FLOATS forbids fused multiply-add, which the
# recordings of real devices do not have. HEADERS_OF names header-only libraries that our headers do
# not show: whoever links to us later does not need them.
function(armjig_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EMBEDDABLE;EXACT_FLOATS" ""
                        "SOURCES;ONLY;EXCEPT;INSTALLED;PUBLIC;PRIVATE;HEADERS_OF")
  list(TRANSFORM arg_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/)
  list(TRANSFORM arg_SOURCES APPEND /*.cpp OUTPUT_VARIABLE sources)
  list(TRANSFORM arg_SOURCES APPEND /*.hpp OUTPUT_VARIABLE headers)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${sources})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${headers})
  if(arg_ONLY OR arg_EXCEPT)
    list(JOIN arg_ONLY "|" only)
    list(JOIN arg_EXCEPT "|" except)
    if(arg_ONLY)
      list(FILTER sources INCLUDE REGEX "/(${only})\\.cpp$")
      list(FILTER headers INCLUDE REGEX "/(${only})\\.hpp$")
    else()
      list(FILTER sources EXCLUDE REGEX "/(${except})\\.cpp$")
      list(FILTER headers EXCLUDE REGEX "/(${except})\\.hpp$")
    endif()
  endif()
  if(arg_INSTALLED)
    list(JOIN arg_INSTALLED "|" installed)
    list(FILTER headers INCLUDE REGEX "/(${installed})\\.hpp$")
  endif()
  list(TRANSFORM arg_HEADERS_OF REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  add_library(armjig_${name} STATIC ${sources})
  add_library(armjig::${name} ALIAS armjig_${name})
  set_target_properties(armjig_${name} PROPERTIES EXPORT_NAME ${name})
  target_sources(armjig_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                 FILES ${headers})
  # For #include <armjig/...>, beside the spelling of this tree.
  target_include_directories(armjig_${name}
                             INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_property(GLOBAL APPEND PROPERTY ARMJIG_LIBRARIES armjig_${name})
  target_compile_features(armjig_${name} PUBLIC cxx_std_20)
  target_link_libraries(armjig_${name} PUBLIC ${arg_PUBLIC}
                        PRIVATE ${arg_PRIVATE} ${arg_HEADERS_OF} $<BUILD_INTERFACE:armjig_flags>)
  armjig_unite(armjig_${name})
  if(arg_EXACT_FLOATS)
    target_compile_options(armjig_${name} PRIVATE -ffp-contract=off)
  endif()
  set(component dev)
  set(targets armjigTargets)
  if(arg_EMBEDDABLE)
    set(component embedded)
    set(targets armjigEmbeddedTargets)
  endif()
  install(TARGETS armjig_${name} EXPORT ${targets}
          ARCHIVE COMPONENT ${component}
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/armjig COMPONENT ${component})
endfunction()
