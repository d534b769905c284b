#include "relax/progression/open_preconditions.hpp"

namespace relax {

bool OpenPreconditions::can_be_met(const OrderedTasks& network) {
    occurring_.clear();
    for (const TaskId task : network.tasks) {
        occurring_.push_back(&problem_.profile(task, limits_));
    }
    turn_round(network, successors_);
    for (std::size_t task = 0; task < network.tasks.size(); ++task) {
        for (const Literal literal : occurring_[task]->preconditions) {
            if (!can_be_met(network, task, literal)) {
                return false;
            }
        }
    }
    return true;
}

bool OpenPreconditions::can_be_met(const OrderedTasks& network, std::size_t task, Literal literal) {
    limits_.stop_if_reached();
    threats_.assign(network.words, 0);
    bool is_threatened = false;
    for (std::size_t earlier = 0; earlier < network.tasks.size(); ++earlier) {
        if (network.is_before(earlier, task) && occurring_[earlier]->undoes.contains(literal)) {
            set_bit(threats_, earlier);
            is_threatened = true;
        }
    }
    if (!is_threatened && holds(initial_state_, literal)) {
        return true;
    }
    for (std::size_t maker = 0; maker < network.tasks.size(); ++maker) {
        if (maker != task && occurring_[maker]->makes.contains(literal) && !network.is_before(task, maker) &&
            !intersect(successors_.row(maker), threats_)) {
            return true;
        }
    }
    return false;
}

}  // namespace relax
