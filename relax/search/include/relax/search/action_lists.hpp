#ifndef RELAX_SEARCH_ACTION_LISTS_HPP
#define RELAX_SEARCH_ACTION_LISTS_HPP

#include <cstdint>
#include <vector>

#include "relax/base/id_table.hpp"
#include "relax/base/ids.hpp"
#include "relax/base/segmented_array.hpp"

namespace relax {

// An action as plans show it: all cases of an action have the same name.
using ActionName = std::uint32_t;

using ActionListId = Id<struct ActionListTag>;

// Lists of actions, each kept once: equal lists have equal numbers. A list is its last action and the number of the
// list of all before it.
class ActionLists {
public:
    static constexpr ActionListId kEmpty{0};

    ActionLists() { cells_.push_back({0, kEmpty}); }

    // The list with one more action, at the end.
    ActionListId append(ActionListId list, ActionName action) { return intern(action, list); }
    // The sorted list with one more action, where it belongs. Lists that are made this way alone stand for multisets.
    ActionListId insert(ActionListId list, ActionName action);

private:
    struct Cell {
        ActionName last;
        ActionListId before;
    };

    ActionListId intern(ActionName last, ActionListId before);

    SegmentedArray<Cell> cells_;
    IdTable<ActionListId> table_;
    std::vector<ActionName> later_;
};

}  // namespace relax

#endif
