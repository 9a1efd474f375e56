# Files of the repository as texts in the program. pellucid_embed_files(<out-variable> DIR … PATTERNS … HEADER …
# NAMESPACE … TYPE … FUNCTION …) makes a .cpp that defines, in NAMESPACE, `const std::vector<TYPE>& FUNCTION()` as
# HEADER declares it: for every file below DIR (from the root of the repository) that fits a pattern, its path below DIR
# and its text, sorted by path. Run as a script it writes that file.
if(CMAKE_SCRIPT_MODE_FILE)
    set(globs ${PATTERNS})
    list(TRANSFORM globs PREPEND ${ROOT}/${DIR}/)
    file(GLOB_RECURSE names RELATIVE ${ROOT}/${DIR} ${globs})
    list(SORT names)
    set(code "// Made from ${DIR}/ by cmake/embed_files.cmake.\n#include \"${HEADER}\"\n\n")
    string(APPEND code "namespace ${NAMESPACE} {\n\nconst std::vector<${TYPE}>& ${FUNCTION}() {\n")
    string(APPEND code "    static const std::vector<${TYPE}> files{\n")
    foreach(name IN LISTS names)
        file(READ ${ROOT}/${DIR}/${name} text)
        string(APPEND code "        {\"${name}\", R\"pellucid(${text})pellucid\"},\n")
    endforeach()
    string(APPEND code "    };\n    return files;\n}\n\n} // namespace ${NAMESPACE}\n")
    file(WRITE ${OUTPUT} "${code}")
    return()
endif()

set(PELLUCID_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(pellucid_embed_files out)
    cmake_parse_arguments(arg "" "DIR;HEADER;NAMESPACE;TYPE;FUNCTION" "PATTERNS" ${ARGN})
    set(globs ${arg_PATTERNS})
    list(TRANSFORM globs PREPEND ${CMAKE_SOURCE_DIR}/${arg_DIR}/)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS ${globs})
    set(cpp ${CMAKE_CURRENT_BINARY_DIR}/${out}.cpp)
    add_custom_command(OUTPUT ${cpp}
        COMMAND ${CMAKE_COMMAND} -DROOT=${CMAKE_SOURCE_DIR} -DDIR=${arg_DIR} "-DPATTERNS=${arg_PATTERNS}"
                -DHEADER=${arg_HEADER} -DNAMESPACE=${arg_NAMESPACE} -DTYPE=${arg_TYPE} -DFUNCTION=${arg_FUNCTION}
                -DOUTPUT=${cpp} -P ${PELLUCID_EMBED_SCRIPT}
        DEPENDS ${files} ${PELLUCID_EMBED_SCRIPT} COMMENT "Embedding ${arg_DIR}" VERBATIM)
    set(${out} ${cpp} PARENT_SCOPE)
endfunction()
