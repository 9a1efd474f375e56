# Programs that are copied to other machines need no library there but glibc's (and at run time the driver's libEGL).
# Layers whose libraries would be needed choose another way for them: the property PELLUCID_PORTABLE of the program that
# is linked in the end decides, wherever a layer's link line asks $<IF:${PELLUCID_IS_PORTABLE},this,that>.
set(PELLUCID_IS_PORTABLE "$<BOOL:$<TARGET_PROPERTY:PELLUCID_PORTABLE>>")
# Threads of the standard library in the place of TBB's: the thread sanitizer cannot look into those.
set(PELLUCID_STANDARD_THREADS ${PELLUCID_IS_PORTABLE})
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
    set(PELLUCID_STANDARD_THREADS 1)
endif()

function(pellucid_make_portable target)
    set_target_properties(${target} PROPERTIES PELLUCID_PORTABLE ON)
    string(FIND "${CMAKE_CXX_FLAGS}" "-fsanitize" sanitized) # the sanitizers' libraries want the C++ library shared
    if(sanitized EQUAL -1)
        # No symbol of ours or of the C++ library may meet those that a driver brings along.
        target_link_options(${target} PRIVATE -static-libstdc++ -static-libgcc -Wl,--exclude-libs,ALL
                            $<$<CONFIG:Release>:-s>)
    endif()
endfunction()
