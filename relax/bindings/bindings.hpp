#ifndef RELAX_BINDINGS_BINDINGS_HPP
#define RELAX_BINDINGS_BINDINGS_HPP

#include <nanobind/nanobind.h>

void bind_lifted_problem(nanobind::module_& module);
void bind_ground_problem(nanobind::module_& module);
void bind_priced_problem(nanobind::module_& module);
void bind_search_options(nanobind::module_& module);
void bind_find_plans(nanobind::module_& module);
void bind_label_search(nanobind::module_& module);
void bind_laws(nanobind::module_& module);
void bind_policy_space(nanobind::module_& module);
void bind_valuations(nanobind::module_& module);
void bind_scenarios(nanobind::module_& module);
void bind_policies(nanobind::module_& module);
void bind_policy_search(nanobind::module_& module);

#endif
