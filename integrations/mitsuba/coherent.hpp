// What the emitter `laser` tells the integrator `speckle`.

#pragma once

#include <mitsuba/render/emitter.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <typeinfo>

namespace mitsuba {

/// A bit of an emitter's flags that Mitsuba leaves free: the light is coherent.
constexpr uint32_t COHERENT = 0x1000;

template <typename Float, typename Spectrum>
bool is_coherent(const Emitter<Float, Spectrum> *emitter) {
    return (emitter->flags() & COHERENT) != 0;
}

/// Reads a number among the parameters that an object exposes to `mi.traverse`.
class ParameterReader final : public TraversalCallback {
public:
    template <typename Object_>
    static std::optional<double> read(const Object_ *object, std::string_view name) {
        ParameterReader reader(name);
        // A traversal can change an object; this one only looks.
        const_cast<Object_ *>(object)->traverse(&reader);
        return reader.m_value;
    }

protected:
    void put_value(std::string_view name, void *value, uint32_t,
                   const std::type_info &type) override {
        if (name != m_name)
            return;
        if (type == typeid(float) || type == typeid(float &))
            m_value = *static_cast<const float *>(value);
        else if (type == typeid(double) || type == typeid(double &))
            m_value = *static_cast<const double *>(value);
    }

    void put_object(std::string_view, Object *, uint32_t) override {}

private:
    explicit ParameterReader(std::string_view name) : m_name(name) {}

    std::string_view m_name;
    std::optional<double> m_value;
};

} // namespace mitsuba
