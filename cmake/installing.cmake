# Where things are installed, for the folders that install them. What belongs together is one component, and one Debian
# package: cli (pellucid-cli), gui (pellucid), dev (libpellucid-dev); docs are what a plain installation has besides.
find_program(PELLUCID_GZIP gzip REQUIRED)
mark_as_advanced(PELLUCID_GZIP)

# Debian's zsh keeps completions of packages apart from those that are installed by hand.
set(zsh_functions site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
    set(zsh_functions vendor-completions)
endif()
set(PELLUCID_ZSH_FUNCTIONS ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_functions} CACHE STRING "Where zsh finds completions")
mark_as_advanced(PELLUCID_ZSH_FUNCTIONS)

# docs/man/<program>.1, packed. The target <program> has it made.
function(pellucid_install_manual program component)
    set(from ${PROJECT_SOURCE_DIR}/docs/man/${program}.1)
    set(to ${PROJECT_BINARY_DIR}/man/${program}.1.gz)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/man)
    add_custom_command(OUTPUT ${to} DEPENDS ${from} VERBATIM COMMAND ${PELLUCID_GZIP} -9nc ${from} > ${to})
    add_custom_target(${program}_manual DEPENDS ${to})
    add_dependencies(${program} ${program}_manual)
    install(FILES ${to} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
endfunction()

# The day of the packages, so that two builds of a version are the same: SOURCE_DATE_EPOCH, else that of the commit.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
    set(seconds $ENV{SOURCE_DATE_EPOCH})
else()
    execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE seconds
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
set(kept_time "$ENV{SOURCE_DATE_EPOCH}")
if(seconds)
    set(ENV{SOURCE_DATE_EPOCH} ${seconds})
endif()
string(TIMESTAMP PELLUCID_DAY "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(TIMESTAMP PELLUCID_ISO_DAY "%Y-%m-%d" UTC)
set(ENV{SOURCE_DATE_EPOCH} "${kept_time}")
