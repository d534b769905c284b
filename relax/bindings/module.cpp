#include "bindings.hpp"

NB_MODULE(_relax, module) {
    module.doc() = "The compiled core of statehtn: grounding, heuristics and search.";
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
}
