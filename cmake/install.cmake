# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where, and the Debian packages: armjig (component runtime),
# libarmjig-embedded-dev (component embedded) and libarmjig-dev (component dev), which needs it. The
# libraries and their headers: armjig_library().
include(CMakePackageConfigHelpers)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/armjig)
write_basic_package_version_file(armjigConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT armjigEmbeddedTargets NAMESPACE armjig:: DESTINATION ${config_dir}
        COMPONENT embedded)
install(FILES cmake/armjigConfig.cmake ${PROJECT_BINARY_DIR}/armjigConfigVersion.cmake
        DESTINATION ${config_dir} COMPONENT embedded)
# Packages have the licence in another form, in what install_papers() installs.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT docs)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

# The papers of a Debian package, left out of a plain installation.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/package/changelog.in changelog)
execute_process(COMMAND gzip -9nf changelog WORKING_DIRECTORY ${PROJECT_BINARY_DIR}
                COMMAND_ERROR_IS_FATAL ANY)
function(install_papers component package)
  install(FILES cmake/package/copyright ${PROJECT_BINARY_DIR}/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

set(CPACK_COMPONENTS_ALL embedded)
install_papers(embedded libarmjig-embedded-dev)
if(ARMJIG_BUILD_CLI)
  install(EXPORT armjigTargets NAMESPACE armjig:: DESTINATION ${config_dir} COMPONENT dev)
  list(APPEND CPACK_COMPONENTS_ALL dev runtime)
  install_papers(dev libarmjig-dev)
  install_papers(runtime armjig)
  # install_completion(SHELL PATH): where the shell looks for it, below share.
  function(install_completion shell path)
    set(script ${PROJECT_BINARY_DIR}/armjig.${shell})
    add_custom_command(OUTPUT ${script} COMMAND armjig completion ${shell} > ${script} VERBATIM)
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(GET path FILENAME name)
    install(FILES ${script} RENAME ${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder}
            COMPONENT runtime)
    set(printed ${printed} ${script} PARENT_SCOPE)
  endfunction()
  install_completion(bash bash-completion/completions/armjig)
  install_completion(zsh zsh/vendor-completions/_armjig)
  install_completion(fish fish/vendor_completions.d/armjig.fish)
  add_custom_command(OUTPUT armjig.1.gz
                     COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:armjig>
                             -D VERSION=${PROJECT_VERSION}
                             -D DOCUMENTS=${CMAKE_INSTALL_FULL_DOCDIR}/docs -D PAGE=armjig.1
                             -P ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake
                     COMMAND gzip -9nf armjig.1
                     DEPENDS armjig cmake/man_page.cmake VERBATIM)
  add_custom_command(OUTPUT 60-armjig.rules COMMAND armjig doctor --udev-rules > 60-armjig.rules
                     VERBATIM)
  # Where Debian's Wireshark looks for the dissectors of all users, and for programs that capture.
  set(wireshark_dir lib/${CMAKE_LIBRARY_ARCHITECTURE}/wireshark)
  add_custom_command(OUTPUT wireshark/armjig_parol6.lua
                     COMMAND armjig wireshark install --to wireshark DEPENDS armjig VERBATIM)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/wireshark/ DESTINATION ${wireshark_dir}/plugins
          COMPONENT runtime FILES_MATCHING PATTERN "*.lua" PATTERN extcap EXCLUDE)
  configure_file(packaging/wireshark-extcap.in wireshark-extcap @ONLY)
  install(PROGRAMS ${PROJECT_BINARY_DIR}/wireshark-extcap RENAME armjig
          DESTINATION ${wireshark_dir}/extcap COMPONENT runtime)
  add_custom_target(printed ALL DEPENDS ${printed} armjig.1.gz 60-armjig.rules
                                        wireshark/armjig_parol6.lua)
  install(TARGETS armjig RUNTIME COMPONENT runtime)
  install(FILES ${PROJECT_BINARY_DIR}/armjig.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
          COMPONENT runtime)
  install(FILES ${PROJECT_BINARY_DIR}/60-armjig.rules DESTINATION lib/udev/rules.d
          COMPONENT runtime)
  configure_file(packaging/armjig-emulate@.service.in armjig-emulate@.service @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/armjig-emulate@.service DESTINATION lib/systemd/system
          COMPONENT runtime)
  install(DIRECTORY captures/parol6 DESTINATION ${CMAKE_INSTALL_DATADIR}/armjig/captures
          COMPONENT runtime)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The armjig authors <armjig@example.org>")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME armjig)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "Emulates robot-arm controllers to the byte, checks real ones
against the rules of their protocols, and replays recordings of real devices.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libarmjig-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
       "libarmjig-embedded-dev (= ${PROJECT_VERSION})" libedit-dev libpcap-dev
       libpugixml-dev libserialport-dev libtins-dev libtomlplusplus-dev libumockdev-dev liburdfdom-dev libusb-1.0-0-dev
       libusbredirparser-dev zlib1g-dev)
set(CPACK_DEBIAN_DEV_DESCRIPTION "Static libraries and headers of all that the armjig program is
made of, for programs that put devices of their own on the jig.")
set(CPACK_DEBIAN_EMBEDDED_PACKAGE_NAME libarmjig-embedded-dev)
set(CPACK_DEBIAN_EMBEDDED_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_EMBEDDED_PACKAGE_DEPENDS "libexpected-dev, libfmt-dev")
set(CPACK_DEBIAN_EMBEDDED_DESCRIPTION "Static libraries, headers and the CMake package of what
needs no operating system: codecs, dissectors, kinematics and emulated devices.")
include(CPack)
