# SPDX-License-Identifier: Apache-2.0
# Writes the C++ source TABLE: in which line of the documents given each requirement stands, that is
# where a line begins with its name, as in "- **`parol6.frame.size`** ...".
#
#   cmake -D TABLE=document_lines.cpp -P document_lines.cmake docs/spec/parol6.md ...
foreach(index RANGE ${CMAKE_ARGC})
  list(APPEND documents ${CMAKE_ARGV${index}})
endforeach()
list(FILTER documents INCLUDE REGEX "\\.md$")

set(tables)
set(rows)
set(count 0)
foreach(document IN LISTS documents)
  file(READ ${document} text)
  # What means something in a list of CMake goes, so that each line is one element.
  string(REGEX REPLACE "[][;\\]" "" text "${text}")
  string(REPLACE "\n" ";" lines "${text}")
  set(number 0)
  set(table)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(line MATCHES "^- \\*\\*`([^`]+)`\\*\\*")
      string(APPEND table "    {\"${CMAKE_MATCH_1}\", ${number}},\n")
    endif()
  endforeach()
  # A page may have none yet: what is generated in it is written by a test that links this.
  set(found {})
  if(table)
    set(found kLines${count})
    string(APPEND tables "constexpr DocumentLine ${found}[] = {\n${table}};\n")
  endif()
  string(APPEND rows "    {\"${document}\", ${found}},\n")
  math(EXPR count "${count} + 1")
endforeach()

file(WRITE ${TABLE} "// Made by cmake/document_lines.cmake.
#include \"conformance/shipped_documents.hpp\"

namespace armjig {
namespace {

${tables}
constexpr Document kDocuments[] = {
${rows}};

}  // namespace

std::span<const Document> shipped_documents() noexcept { return kDocuments; }

}  // namespace armjig
")
