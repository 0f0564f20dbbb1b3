# SPDX-License-Identifier: Apache-2.0
# Writes the manual page PAGE from what the program says of itself: its help, and below it that of
# every subcommand, as they are.
#
#   cmake -D PROGRAM=armjig -D VERSION=0.1.0 -D DOCUMENTS=/usr/share/doc/armjig/docs
#         -D PAGE=armjig.1 -P man_page.cmake

function(read_help out)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE help
                  COMMAND_ERROR_IS_FATAL ANY)
  set(${out} "${help}" PARENT_SCOPE)
endfunction()

# As lines that are not filled.
function(append_verbatim text)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REPLACE "'" "\\(aq" text "${text}")
  string(REPLACE "\n." "\n\\&." text "${text}")
  string(STRIP "${text}" text)
  set(page "${page}.nf\n${text}\n.fi\n" PARENT_SCOPE)
endfunction()

# All subcommands in the help of ARGN, each before its own.
function(append_subcommands help)
  string(REGEX REPLACE "^.*\nSubcommands:\n" "" list "${help}")
  if(list STREQUAL help)
    return()
  endif()
  string(REGEX MATCHALL "(^|\n)  [a-z][a-z0-9-]*  " names "${list}")
  foreach(name IN LISTS names)
    string(STRIP "${name}" name)
    read_help(its_help ${ARGN} ${name})
    string(REGEX REPLACE "\nExit codes:.*$" "\n" its_own "${its_help}")
    string(JOIN " " title armjig ${ARGN} ${name})
    string(REPLACE "-" "\\-" title "${title}")
    string(APPEND page ".SS ${title}\n")
    append_verbatim("${its_own}")
    append_subcommands("${its_help}" ${ARGN} ${name})
  endforeach()
  set(page "${page}" PARENT_SCOPE)
endfunction()

read_help(help)
string(REGEX MATCH "^[^\n]*[^\n.]" first "${help}")
set(page ".TH ARMJIG 1 \"\" \"armjig ${VERSION}\" \"User Commands\"\n")
string(REPLACE "-" "\\-" first "${first}")
string(APPEND page ".SH NAME\narmjig \\- ${first}\n.SH SYNOPSIS\n.B armjig\n"
                   ".I SUBCOMMAND\n[\\fIOPTION\\fR]...\n.SH DESCRIPTION\n")
append_verbatim("${help}")
string(APPEND page ".SH SUBCOMMANDS\n")
append_subcommands("${help}")
string(APPEND page ".SH SEE ALSO\n.I ${DOCUMENTS}/cli.md\n.br\n.I ${DOCUMENTS}/README.md\n")
file(WRITE ${PAGE} "${page}")
