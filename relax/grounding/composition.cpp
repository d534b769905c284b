#include "composition.hpp"

#include <algorithm>
#include <cassert>
#include <optional>

#include "relax/base/bits.hpp"

namespace relax::grounding {

namespace {

constexpr std::uint32_t kMostSubtasks = 64;
constexpr std::uint32_t kMostParts = 64;

// Whether copying a network to all its users takes no more memory than a task and a method of its own.
bool is_worth_copying(std::uint32_t subtasks, std::uint32_t users) {
    constexpr std::uint64_t kTaskAndMethod = 4;
    return std::uint64_t{users} * subtasks <= std::uint64_t{users} + subtasks + kTaskAndMethod;
}

Ordering transitive_closure(const LiftedMethod& method, Limits& limits) {
    const std::size_t count = method.subtasks.size();
    const std::size_t words = words_for(count);
    std::vector<std::uint64_t> after(count * words, 0);  // a row of bits for every subtask
    const auto row = [&](std::size_t earlier) { return std::span(after).subspan(earlier * words, words); };
    for (const auto& [earlier, later] : method.ordering) {
        set_bit(row(earlier), later);
    }
    for (std::size_t between = 0; between < count; ++between) {
        for (std::size_t earlier = 0; earlier < count; ++earlier) {
            if (has_bit(row(earlier), between)) {
                limits.stop_if_reached();
                for (std::size_t word = 0; word < words; ++word) {
                    row(earlier)[word] |= row(between)[word];
                }
            }
        }
    }
    Ordering closure;
    for (std::uint32_t earlier = 0; earlier < count; ++earlier) {
        limits.stop_if_reached();
        for (std::uint32_t later = 0; later < count; ++later) {
            if (has_bit(row(earlier), later)) {
                closure.emplace_back(earlier, later);
            }
        }
    }
    return closure;
}

}  // namespace

Composition::Composition(const LiftedProblem& lifted, TaskGraph& graph, const std::vector<bool>& is_trivial,
                         const std::vector<NodeId>& stands_for, const GroundingOptions& options, Limits& limits)
    : graph_(graph),
      limits_(limits),
      is_trivial_(is_trivial),
      stands_for_(stands_for),
      is_replaced_(graph.is_node_alive.size(), false) {
    for (const LiftedMethod& method : lifted.methods) {
        orderings_.push_back(transitive_closure(method, limits));
    }
    if (options.merge_equal) {
        drop_equal_methods(limits);
    }
    if (options.replace_single_methods) {
        choose_replaced(limits);
    }
}

void Composition::drop_equal_methods(Limits& limits) {
    // By what two methods of a task are equal: their subtasks that do not vanish, and the order of these.
    struct Content {
        MethodInstanceId method;
        std::vector<NodeId> subtasks;
        Ordering ordering;
    };
    std::vector<Content> contents;
    for (NodeId node = graph_.action_node_count; node < graph_.is_node_alive.size(); ++node) {
        if (!graph_.is_node_alive[node]) {
            continue;
        }
        limits.stop_if_reached();
        contents.clear();
        const auto [first, end] = graph_.methods_of[node - graph_.action_node_count];
        for (MethodInstanceId method = first; method < end; ++method) {
            if (graph_.is_method_alive[method]) {
                limits.stop_if_reached();
                const std::span<const NodeId> subtasks = graph_.method_subtasks[method];
                std::vector<std::uint32_t> place(subtasks.size());
                Content content{method, {}, {}};
                for (std::size_t position = 0; position < subtasks.size(); ++position) {
                    place[position] = static_cast<std::uint32_t>(content.subtasks.size());
                    if (!vanishes(subtasks[position])) {
                        content.subtasks.push_back(stands_for_[subtasks[position]]);
                    }
                }
                for (const auto& [earlier, later] : orderings_[graph_.method_schema[method]]) {
                    if (!vanishes(subtasks[earlier]) && !vanishes(subtasks[later])) {
                        content.ordering.emplace_back(place[earlier], place[later]);
                    }
                }
                contents.push_back(std::move(content));
            }
        }
        std::ranges::sort(contents, [&limits](const Content& left, const Content& right) {
            limits.stop_if_reached();
            return std::tie(left.subtasks, left.ordering, left.method) <
                   std::tie(right.subtasks, right.ordering, right.method);
        });
        for (std::size_t at = 1; at < contents.size(); ++at) {
            if (contents[at - 1].subtasks == contents[at].subtasks &&
                contents[at - 1].ordering == contents[at].ordering) {
                graph_.is_method_alive[contents[at].method] = false;
            }
        }
    }
}

// Bottom-up: whether a task is replaced depends on how many subtasks it would leave behind.
void Composition::choose_replaced(Limits& limits) {
    struct Size {
        std::uint32_t subtasks = 0;
        std::uint32_t parts = 0;  // 0: not yet known
    };
    const std::size_t nodes = graph_.is_node_alive.size();
    std::vector<std::uint32_t> use_count(nodes, 0);
    std::vector<std::optional<MethodInstanceId>> only_method(nodes);
    for (NodeId node = graph_.action_node_count; node < nodes; ++node) {
        const auto [first, end] = graph_.methods_of[node - graph_.action_node_count];
        std::uint32_t count = 0;
        limits.stop_if_reached();
        for (MethodInstanceId method = first; graph_.is_node_alive[node] && method < end; ++method) {
            if (graph_.is_method_alive[method]) {
                only_method[node] = ++count == 1 ? std::optional(method) : std::nullopt;
                for (const NodeId subtask : graph_.method_subtasks[method]) {
                    ++use_count[subtask];
                }
            }
        }
    }
    only_method[graph_.initial].reset();
    std::vector<Size> sizes(nodes);
    // Tasks of a single method cannot contain each other, so that a depth-first search ends.
    std::vector<NodeId> stack;
    for (NodeId root = graph_.action_node_count; root < nodes; ++root) {
        limits.stop_if_reached();
        stack.push_back(root);
        while (!stack.empty()) {
            const NodeId node = stack.back();
            if (!only_method[node] || sizes[node].parts > 0) {
                stack.pop_back();
                continue;
            }
            const std::span<const NodeId> subtasks = graph_.method_subtasks[*only_method[node]];
            const std::size_t height = stack.size();
            for (const NodeId subtask : subtasks) {
                if (only_method[subtask] && sizes[subtask].parts == 0) {
                    stack.push_back(subtask);
                }
            }
            if (stack.size() > height) {
                continue;
            }
            stack.pop_back();
            Size size{0, 1};
            for (const NodeId subtask : subtasks) {
                size.subtasks += is_replaced_[subtask] ? sizes[subtask].subtasks : vanishes(subtask) ? 0 : 1;
                size.parts += is_replaced_[subtask] ? sizes[subtask].parts : 0;
            }
            sizes[node] = size;
            is_replaced_[node] = size.subtasks <= kMostSubtasks && size.parts <= kMostParts &&
                                 is_worth_copying(size.subtasks, use_count[node]);
        }
    }
}

ComposedNetwork Composition::compose(MethodInstanceId method) const {
    ComposedNetwork network;
    append(method, 0, 0, network);
    std::ranges::sort(network.ordering);
    assert(std::ranges::all_of(network.ordering, [&](const auto& pair) {
        return pair.first != pair.second && pair.first < network.subtasks.size() &&
               pair.second < network.subtasks.size();
    }));
    return network;
}

void Composition::append(MethodInstanceId method, std::uint32_t parent, std::uint32_t position,
                         ComposedNetwork& network) const {
    const auto part = static_cast<std::uint32_t>(network.parts.size());
    network.parts.push_back({method, parent, position});
    const std::span<const NodeId> subtasks = graph_.method_subtasks[method];
    std::vector<std::uint32_t> begin;  // by subtask: where what became of it begins
    for (std::uint32_t at = 0; at < subtasks.size(); ++at) {
        begin.push_back(static_cast<std::uint32_t>(network.subtasks.size()));
        if (is_replaced_[subtasks[at]]) {
            const auto [first, end] = graph_.methods_of[subtasks[at] - graph_.action_node_count];
            const auto only =
                std::find(graph_.is_method_alive.begin() + first, graph_.is_method_alive.begin() + end, true);
            append(static_cast<MethodInstanceId>(only - graph_.is_method_alive.begin()), part, at, network);
        } else if (!vanishes(subtasks[at])) {
            network.subtasks.push_back({stands_for_[subtasks[at]], part, at});
        }
    }
    begin.push_back(static_cast<std::uint32_t>(network.subtasks.size()));
    for (const auto& [earlier, later] : orderings_[graph_.method_schema[method]]) {
        limits_.stop_if_reached();
        for (std::uint32_t first = begin[earlier]; first < begin[earlier + 1]; ++first) {
            for (std::uint32_t second = begin[later]; second < begin[later + 1]; ++second) {
                network.ordering.emplace_back(first, second);
            }
        }
    }
}

}  // namespace relax::grounding
