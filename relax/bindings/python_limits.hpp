#ifndef RELAX_BINDINGS_PYTHON_LIMITS_HPP
#define RELAX_BINDINGS_PYTHON_LIMITS_HPP

#include <nanobind/nanobind.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "relax/base/limits.hpp"

// Limits for a computation that runs without the GIL: `seconds` from now, `bytes` of resident memory, `steps`. Now and
// then the GIL is taken, signals are handled and `watch` is called; a KeyboardInterrupt ends the computation with its
// result so far, any other exception ends it and is raised.
inline relax::Limits python_limits(std::optional<double> seconds, std::optional<std::size_t> bytes,
                                   std::optional<std::uint64_t> steps, std::function<void()> watch = {}) {
    namespace nb = nanobind;
    relax::Limits limits;
    if (seconds) {
        constexpr double kMostSeconds = 1e9;  // some thirty years, well within what the clock can hold
        const std::chrono::duration<double> span(std::min(*seconds, kMostSeconds));
        limits.deadline =
            relax::Limits::Clock::now() + std::chrono::duration_cast<relax::Limits::Clock::duration>(span);
    }
    limits.memory_bytes = bytes;
    limits.steps = steps;
    limits.poll = [watch = std::move(watch)] {
        const nb::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) {
            if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) {
                throw nb::python_error();
            }
            PyErr_Clear();
            return true;
        }
        try {
            if (watch) {
                watch();
            }
        } catch (const nb::python_error& error) {  // Ctrl-C while the callback runs is one, too
            if (!error.matches(PyExc_KeyboardInterrupt)) {
                throw;
            }
            return true;
        }
        return false;
    };
    return limits;
}

#endif
