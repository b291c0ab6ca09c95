// Reading the properties of a plugin: what is wrong is refused with the name of the property.

#pragma once

#include <mitsuba/core/properties.h>

#include <tem00.h>

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
using Names = std::map<std::string, std::string, std::less<>>;

/// Throws the library's last error under the name of the property, unless `status` is success.
inline void check(tem00_status status, std::string_view plugin, const Names &names = {}) {
    if (status == TEM00_STATUS_OK)
        return;
    const std::string parameter = tem00_last_error_parameter();
    if (parameter.empty())
        Throw("%s: %s", plugin, tem00_last_error());
    const auto found = names.find(parameter);
    Throw("%s: %s: %s", plugin, found == names.end() ? parameter : found->second,
          tem00_last_error());
}

} // namespace mitsuba
