# Every file under SHADER_DIR becomes one entry of a generated .cpp: name (path relative to SHADER_DIR) → source.
# Included by a CMakeLists.txt it gives pellucid_embed_shaders(<out-variable>); run as a script it writes the file.
if(CMAKE_SCRIPT_MODE_FILE)
    file(GLOB_RECURSE names RELATIVE ${SHADER_DIR} ${SHADER_DIR}/*.vert ${SHADER_DIR}/*.frag ${SHADER_DIR}/*.comp
         ${SHADER_DIR}/*.glsl)
    list(SORT names)
    set(code "// Made from shaders/ by cmake/embed_shaders.cmake.\n#include \"render/gl/shader_source.h\"\n\n")
    string(APPEND code "namespace pellucid::gl {\n\n")
    string(APPEND code "const std::vector<EmbeddedShader>& embeddedShaders() {\n")
    string(APPEND code "    static const std::vector<EmbeddedShader> shaders{\n")
    foreach(name IN LISTS names)
        file(READ ${SHADER_DIR}/${name} source)
        string(APPEND code "        {\"${name}\", R\"pellucid(${source})pellucid\"},\n")
    endforeach()
    string(APPEND code "    };\n    return shaders;\n}\n\n} // namespace pellucid::gl\n")
    file(WRITE ${OUTPUT} "${code}")
    return()
endif()

set(PELLUCID_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(pellucid_embed_shaders out)
    set(dir ${CMAKE_SOURCE_DIR}/shaders)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS ${dir}/*.vert ${dir}/*.frag ${dir}/*.comp ${dir}/*.glsl)
    set(cpp ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
    add_custom_command(OUTPUT ${cpp}
        COMMAND ${CMAKE_COMMAND} -DSHADER_DIR=${dir} -DOUTPUT=${cpp} -P ${PELLUCID_EMBED_SCRIPT}
        DEPENDS ${files} ${PELLUCID_EMBED_SCRIPT} COMMENT "Embedding shaders" VERBATIM)
    set(${out} ${cpp} PARENT_SCOPE)
endfunction()
