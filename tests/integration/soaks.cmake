# SPDX-License-Identifier: Apache-2.0
# What takes minutes to hours: ctest -L soak.

# All faulty boards: every one that is not equivalent is found, every must is broken by one.
add_test(NAME soak.mutants COMMAND armjig conformance mutants parol6)
set_tests_properties(soak.mutants PROPERTIES LABELS soak TIMEOUT 1800)

# ctest -L soak; ARMJIG_SOAK_MINUTES sets the length, 10 if it is not set.
foreach(soak IN ITEMS garbage kinovazed resets)
  add_executable(${soak}_soak ${soak}_soak.cpp)
  target_link_libraries(${soak}_soak PRIVATE integration_support)
  add_test(NAME soak.${soak} COMMAND ${soak}_soak)
  set_tests_properties(soak.${soak} PROPERTIES LABELS soak TIMEOUT 86400)
endforeach()

# Random sessions: they verify, and fast emulators do what their plain models do.
add_executable(sessions_soak sessions_soak.cpp)
target_link_libraries(sessions_soak PRIVATE armjig_replay armjig_sessions Threads::Threads
                                            fmt::fmt armjig_flags)
add_test(NAME soak.sessions COMMAND sessions_soak)
set_tests_properties(soak.sessions PROPERTIES LABELS soak TIMEOUT 86400)

# A minute: a thousand places of each device's recordings, and a thousand answers, are changed.
add_executable(alterations_soak alterations_soak.cpp)
target_link_libraries(alterations_soak PRIVATE armjig_replay armjig_harness fmt::fmt armjig_flags)
add_test(NAME soak.alterations COMMAND alterations_soak ${PROJECT_SOURCE_DIR}/captures)
set_tests_properties(soak.alterations PROPERTIES LABELS soak TIMEOUT 3600)

# A quarter of an hour: every link breaks a thousand times, at random moments, while a program talks over it. Those of
# a real kernel are below.
add_test(NAME soak.breaks COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/unplug_soak.py
                                  $<TARGET_FILE:armjig>)
set_tests_properties(soak.breaks PROPERTIES LABELS soak TIMEOUT 7200)

# Some ten minutes: every recording to a hosted emulated device, in real time over real links.
add_executable(hosted_replay_soak hosted_replay_soak.cpp)
target_link_libraries(hosted_replay_soak PRIVATE integration_support fmt::fmt)
add_test(NAME soak.hosted_replay COMMAND hosted_replay_soak)
set_tests_properties(soak.hosted_replay PROPERTIES LABELS soak TIMEOUT 7200 RUN_SERIAL TRUE)

# Half a minute: what measuring costs, beside a bare echo.
add_executable(latency_soak latency_soak.cpp)
target_link_libraries(latency_soak PRIVATE integration_support fmt::fmt)
add_test(NAME soak.latency COMMAND latency_soak)
set_tests_properties(soak.latency PROPERTIES LABELS soak TIMEOUT 600 RUN_SERIAL TRUE)

# Some minutes: what hosting 300 boards costs, and a command, beside bare echoes.
add_executable(boards_soak boards_soak.cpp)
target_link_libraries(boards_soak PRIVATE integration_support fmt::fmt)
add_test(NAME soak.boards COMMAND boards_soak)
set_tests_properties(soak.boards PROPERTIES LABELS soak TIMEOUT 1800 RUN_SERIAL TRUE)

# A minute: what the tap costs, beside a relay that does nothing but poll, read and write.
add_executable(tap_soak tap_soak.cpp)
target_link_libraries(tap_soak PRIVATE integration_support fmt::fmt util)
add_test(NAME soak.tap COMMAND tap_soak)
set_tests_properties(soak.tap PROPERTIES LABELS soak TIMEOUT 600 RUN_SERIAL TRUE)

# Two minutes: its schedule beside cyclictest's, and a host that is stopped. Needs rt-tests, which
# scripts/bootstrap --dev installs.
add_test(NAME soak.latency_host
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/latency_host_soak.py
                 $<TARGET_FILE:armjig>)
set_tests_properties(soak.latency_host PROPERTIES LABELS soak TIMEOUT 600 RUN_SERIAL TRUE)

# An hour: how often `latency --against` is right on real pseudo-terminals.
add_executable(delayed_echo delayed_echo.cpp)
target_link_libraries(delayed_echo PRIVATE armjig_harness fmt::fmt util)
add_test(NAME soak.latency_against
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/latency_against_soak.py
                 $<TARGET_FILE:armjig> $<TARGET_FILE:delayed_echo>)
set_tests_properties(soak.latency_against PROPERTIES LABELS soak TIMEOUT 36000 RUN_SERIAL TRUE)

# Minutes: the same in virtual time.
add_executable(latency_trials_soak latency_trials_soak.cpp)
target_link_libraries(latency_trials_soak PRIVATE integration_support fmt::fmt)
add_test(NAME soak.latency_trials COMMAND latency_trials_soak)
set_tests_properties(soak.latency_trials PROPERTIES LABELS soak TIMEOUT 3600)

add_executable(reachable_poses_soak reachable_poses_soak.cpp)
target_link_libraries(reachable_poses_soak PRIVATE armjig_arm fmt::fmt armjig_flags)
add_test(NAME soak.reachable_poses COMMAND reachable_poses_soak)
set_tests_properties(soak.reachable_poses PROPERTIES LABELS soak TIMEOUT 3600)

# Minutes, and 5 GB of disk: recordings of any size in little memory.
add_test(NAME soak.trace
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/trace_soak.py $<TARGET_FILE:armjig>
                 ${PROJECT_SOURCE_DIR}/captures/parol6/random_30s_a.jsonl)
set_tests_properties(soak.trace PROPERTIES LABELS soak TIMEOUT 7200)

# In a guest with a kernel of its own, with its driver and without: a cable that is pulled out 1,000 times, and
# a program that is killed while it moves the arm. Needs what scripts/bootstrap --dev installs.
foreach(target serial:/dev/ttyACM0 usb:0483:5740 i2c: i2c-tiny-usb:)
  string(REGEX REPLACE ":.*" "" link ${target})
  add_test(NAME soak.unplug.${link} COMMAND ${PROJECT_SOURCE_DIR}/tests/kernel/run ${PROJECT_BINARY_DIR}
                                            unplug 1000 ${target})
  set_tests_properties(soak.unplug.${link} PROPERTIES LABELS soak TIMEOUT 7200 SKIP_RETURN_CODE 77)
endforeach()
foreach(target serial:/dev/ttyACM0 usb:0483:5740)
  string(REGEX REPLACE ":.*" "" link ${target})
  add_test(NAME soak.killed.${link} COMMAND ${PROJECT_SOURCE_DIR}/tests/kernel/run ${PROJECT_BINARY_DIR}
                                            killed ${target})
  set_tests_properties(soak.killed.${link} PROPERTIES LABELS soak TIMEOUT 7200 SKIP_RETURN_CODE 77)
endforeach()
add_test(NAME soak.kernel_verdicts COMMAND ${PROJECT_SOURCE_DIR}/tests/kernel/run ${PROJECT_BINARY_DIR} all)
set_tests_properties(soak.kernel_verdicts PROPERTIES LABELS soak TIMEOUT 7200 SKIP_RETURN_CODE 77)
foreach(mode reconnect others usbip)
  add_test(NAME soak.kernel_${mode} COMMAND ${PROJECT_SOURCE_DIR}/tests/kernel/run ${PROJECT_BINARY_DIR} ${mode})
endforeach()
set_tests_properties(soak.kernel_reconnect soak.kernel_others soak.kernel_usbip
                     PROPERTIES LABELS soak TIMEOUT 600 SKIP_RETURN_CODE 77)
add_test(NAME soak.kernel_round_trip COMMAND ${PROJECT_SOURCE_DIR}/tests/kernel/run ${PROJECT_BINARY_DIR}
                                             roundtrip)
set_tests_properties(soak.kernel_round_trip PROPERTIES LABELS soak TIMEOUT 600 SKIP_RETURN_CODE 77)

# Half a minute: a board in a labgrid lab. Needs labgrid, of PyPI.
add_test(NAME soak.labgrid COMMAND ${PROJECT_SOURCE_DIR}/examples/labgrid/run $<TARGET_FILE:armjig>)
set_tests_properties(soak.labgrid PROPERTIES LABELS soak TIMEOUT 300 SKIP_RETURN_CODE 77)

# Some ten minutes: campaigns find ten defects for each device that its suite does not see.
add_test(NAME soak.rare_defects
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/rare_defects_soak.py
                 $<TARGET_FILE:armjig> ${PROJECT_SOURCE_DIR})
set_tests_properties(soak.rare_defects PROPERTIES LABELS soak TIMEOUT 3600)

# Half an hour, twenty minutes and ten: the same defects live over pseudo-terminal, TCP and virtual bus; sound devices
# side by side, and how their emulators grow; what is known, without its file.
foreach(what rare sound known)
  add_test(NAME soak.live_fuzz.${what}
           COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/live_fuzz_soak.py $<TARGET_FILE:armjig>
                   ${PROJECT_SOURCE_DIR} ${what})
  set_tests_properties(soak.live_fuzz.${what} PROPERTIES LABELS soak TIMEOUT 7200 RUN_SERIAL TRUE)
endforeach()

# Hours: whole suites with hands and restarts accuse no sound device, beside busy loops either.
add_test(NAME soak.verdicts COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/verdicts_soak.py
                                    $<TARGET_FILE:armjig>)
set_tests_properties(soak.verdicts PROPERTIES LABELS soak TIMEOUT 86400 RUN_SERIAL TRUE)
