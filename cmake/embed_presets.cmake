# Every transfer function in data/tf/presets becomes one entry of a generated .cpp: name (the file's, without
# .tf.json) → its text. Included by a CMakeLists.txt it gives pellucid_embed_presets(<out-variable>); run as a script it
# writes the file.
if(CMAKE_SCRIPT_MODE_FILE)
    file(GLOB names RELATIVE ${PRESET_DIR} ${PRESET_DIR}/*.tf.json)
    list(SORT names)
    set(code "// Made from data/tf/presets by cmake/embed_presets.cmake.\n#include \"tf/presets.h\"\n\n")
    string(APPEND code "namespace pellucid {\n\nconst std::vector<EmbeddedPreset>& embeddedPresets() {\n")
    string(APPEND code "    static const std::vector<EmbeddedPreset> presets{\n")
    foreach(name IN LISTS names)
        file(READ ${PRESET_DIR}/${name} text)
        string(REPLACE ".tf.json" "" stem ${name})
        string(APPEND code "        {\"${stem}\", R\"pellucid(${text})pellucid\"},\n")
    endforeach()
    string(APPEND code "    };\n    return presets;\n}\n\n} // namespace pellucid\n")
    file(WRITE ${OUTPUT} "${code}")
    return()
endif()

set(PELLUCID_EMBED_PRESETS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(pellucid_embed_presets out)
    set(dir ${CMAKE_SOURCE_DIR}/data/tf/presets)
    file(GLOB files CONFIGURE_DEPENDS ${dir}/*.tf.json)
    set(cpp ${CMAKE_CURRENT_BINARY_DIR}/embedded_presets.cpp)
    add_custom_command(OUTPUT ${cpp}
        COMMAND ${CMAKE_COMMAND} -DPRESET_DIR=${dir} -DOUTPUT=${cpp} -P ${PELLUCID_EMBED_PRESETS_SCRIPT}
        DEPENDS ${files} ${PELLUCID_EMBED_PRESETS_SCRIPT} COMMENT "Embedding presets" VERBATIM)
    set(${out} ${cpp} PARENT_SCOPE)
endfunction()
