#ifndef RELAX_BINDINGS_ID_CASTER_HPP
#define RELAX_BINDINGS_ID_CASTER_HPP

#include <nanobind/nanobind.h>

#include <cstdint>

#include "relax/base/ids.hpp"

// Ids are numbers in Python.
template <typename Tag>
struct nanobind::detail::type_caster<relax::Id<Tag>> {
    NB_TYPE_CASTER(relax::Id<Tag>, const_name("int"))

    bool from_python(handle source, std::uint8_t flags, cleanup_list* cleanup) noexcept {
        make_caster<std::uint32_t> number;
        if (!number.from_python(source, flags, cleanup)) {
            return false;
        }
        value = relax::Id<Tag>(number.value);
        return true;
    }

    static handle from_cpp(relax::Id<Tag> id, rv_policy policy, cleanup_list* cleanup) noexcept {
        return make_caster<std::uint32_t>::from_cpp(id, policy, cleanup);
    }
};

#endif
