// --limits and --lock: within what opacities may move.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "optimize/solve/opacity_limits.h"
#include "session/scene.h"

namespace pellucid::cli {

class LimitOptions {
public:
    void add(CLI::App& app);
    /// Those of the session, and over them what is given. Throws UsageError where a feature is not there.
    std::vector<OpacityLimits> of(const Scene& scene) const;

private:
    struct NamedLimits {
        std::string name;
        OpacityLimits limits;
    };
    static NamedLimits parse(const std::string& text, const std::string& option);

    std::vector<NamedLimits> m_limits;
    std::vector<std::string> m_locked;
};

} // namespace pellucid::cli
