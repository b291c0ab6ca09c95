// Reading the properties of a plugin: what is wrong is refused with the name of the property.

#pragma once

#include <mitsuba/core/properties.h>

#include <tem00.hpp>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace mitsuba {

/// Refuses a property: "plugin: property: what is wrong".
[[noreturn]] inline void refuse(const Properties &props, std::string_view property,
                                std::string_view reason) {
    Throw("%s: %s: %s", props.plugin_name(), property, reason);
}

/// Returns a number that may be left out.
inline std::optional<double> optional_number(const Properties &props, std::string_view name) {
    if (!props.has_property(name))
        return std::nullopt;
    return props.get<double>(name);
}

/// Returns one of several words by its place, the first if the property is left out.
template <size_t N>
size_t choice(const Properties &props, std::string_view name,
              const std::array<std::string_view, N> &words) {
    const std::string given = props.get<std::string>(name, std::string(words[0]));
    std::string known;
    for (size_t i = 0; i < N; ++i) {
        if (given == words[i])
            return i;
        known += (i ? ", " : "") + ("\"" + std::string(words[i]) + "\"");
    }
    refuse(props, name, "must be one of " + known + ", got \"" + given + "\"");
}

/// Parameters of the library and the properties that they come from; others are called the same.
using Names = std::map<std::string, std::string>;

/// Calls the library. What it refuses is refused under the name of the property.
template <typename Call>
auto named(std::string_view plugin, const Names &names, Call call) {
    try {
        return call();
    } catch (const tem00::error &error) {
        if (error.parameter().empty())
            Throw("%s: %s", plugin, error.what());
        const auto found = names.find(error.parameter());
        const auto &name = found == names.end() ? error.parameter() : found->second;
        Throw("%s: %s: %s", plugin, name, error.what());
    }
}

} // namespace mitsuba
