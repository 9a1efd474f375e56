#include "render/engine_choice.h"

#include "base/error.h"

namespace pellucid {

const char* name(EngineChoice choice) {
    switch (choice) {
    case EngineChoice::Auto:
        return "auto";
    case EngineChoice::Gl:
        return "gl";
    case EngineChoice::Cpu:
        return "cpu";
    case EngineChoice::Slices:
        return "slices";
    case EngineChoice::Reference:
        return "reference";
    }
    return "";
}

EngineChoice engineChoiceFromName(const std::string& text) {
    for (const EngineChoice c :
         {EngineChoice::Auto, EngineChoice::Gl, EngineChoice::Cpu, EngineChoice::Slices, EngineChoice::Reference})
        if (text == name(c)) return c;
    throw UsageError("unknown engine \"" + text + "\"", "engine", "use auto, gl, cpu, slices or reference");
}

const char* name(Quality quality) { return quality == Quality::High ? "high" : "normal"; }

Quality qualityFromName(const std::string& text) {
    for (const Quality q : {Quality::Normal, Quality::High})
        if (text == name(q)) return q;
    throw UsageError("unknown quality '" + text + "'", "quality", "give normal or high");
}

} // namespace pellucid
