#include "bindings.hpp"

namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "Clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* kCompiler = "GCC " __VERSION__;
#else
constexpr const char* kCompiler = "an unknown compiler";
#endif

}  // namespace

NB_MODULE(_relax, module) {
    module.doc() = "The compiled core of statehtn: grounding, heuristics and search.";
#ifdef NDEBUG
    // What a daemon thread holds when the interpreter ends is never freed, which is no fault that its user could mend.
    nanobind::set_leak_warnings(false);
#endif
    module.def("compiler", [] { return kCompiler; }, "By what the core was compiled.");
    bind_lifted_problem(module);
    bind_ground_problem(module);
    bind_priced_problem(module);
    bind_search_options(module);
    bind_find_plans(module);
    bind_valuations(module);
    bind_laws(module);
    bind_scenarios(module);
    bind_label_search(module);
    bind_policies(module);
    bind_policy_space(module);
    bind_policy_search(module);
}
