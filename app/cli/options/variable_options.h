// --variable, --hsb, --features-of: several variables, which of them drives what, and whose features are looked at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "output.h"
#include "session/scene.h"

namespace pellucid::cli {

struct VariableOptions {
    struct Named {
        std::string name, spec;
    };
    std::vector<Named> variables;
    std::optional<std::string> hsb, features;

    void add(CLI::App& app);
    /// After those of VOLUME, whose raw layout and missing value the files of further variables share. A variable of a
    /// name that the session has takes its place; --hsb sets what it names and switches the mapping on, or off;
    /// --features-of puts a variable first. Throws UsageError.
    void applyTo(SceneInputs& inputs) const;

private:
    void applyHsb(Session& session) const;
};

/// Adds "features_of": "volatility:x:10" where features are of a variable that is made of another one, "hsb":
/// {"alpha":"x","saturation":"volatility:x:10","a":12.5,…}, with the scales that were used, and what derived variables
/// are by definition ("definitions") to the result of a command; nothing where colours are those of the transfer
/// function.
void addMapping(Json& result, const Scene& scene);
/// How a derived variable is named and what its values are: {"volatility:x:10":"population standard deviation of …"}.
Json definitionsOf(const Session& session);

} // namespace pellucid::cli
