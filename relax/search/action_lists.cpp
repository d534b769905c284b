#include "relax/search/action_lists.hpp"

namespace relax {

namespace {

std::uint64_t hash_cell(ActionName last, ActionListId before) { return mix((std::uint64_t{last} << 32) | before); }

}  // namespace

ActionListId ActionLists::insert(ActionListId list, ActionName action) {
    later_.clear();
    for (; list != kEmpty && cells_[list].last > action; list = cells_[list].before) {
        later_.push_back(cells_[list].last);
    }
    list = intern(action, list);
    for (; !later_.empty(); later_.pop_back()) {
        list = intern(later_.back(), list);
    }
    return list;
}

ActionListId ActionLists::intern(ActionName last, ActionListId before) {
    const std::uint64_t hash = hash_cell(last, before);
    const auto known =
        table_.find(hash, [&](ActionListId id) { return cells_[id].last == last && cells_[id].before == before; });
    if (known) {
        return *known;
    }
    const auto id = static_cast<ActionListId>(cells_.size());
    cells_.push_back({last, before});
    table_.add(hash, id);
    return id;
}

}  // namespace relax
