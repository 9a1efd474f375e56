# The warnings every target of ours is compiled with; -Werror comes from presets only.
add_library(pellucid_warnings INTERFACE)
target_compile_options(pellucid_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # g++ 12 sees overlaps in std::string concatenation that are not there
    $<$<BOOL:${PELLUCID_WERROR}>:-Werror>)
