# pellucid_compile_together(<target> <groups>)
# With PELLUCID_UNITY the files of a target are compiled some at a time, in so many groups: headers are read once for
# each, and a build from nothing takes about half as long. Names of file-local things have to differ within a group, then.
# The name of a file decides on its group: a new file moves no other one. Files with flags of their own stay by
# themselves. Call it in the target's own folder.
function(pellucid_compile_together target groups)
    if(NOT PELLUCID_UNITY)
        return()
    endif()
    get_target_property(sources ${target} SOURCES)
    foreach(source IN LISTS sources)
        if(source MATCHES "\\.cpp$" AND NOT IS_ABSOLUTE "${source}")
            string(MD5 hash "${source}")
            string(SUBSTRING "${hash}" 0 6 digits)
            math(EXPR group "0x${digits} % ${groups}")
            set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${group})
        endif()
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
