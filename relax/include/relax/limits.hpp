#ifndef RELAX_LIMITS_HPP
#define RELAX_LIMITS_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace relax {

enum class StopReason : std::uint8_t { TimeLimit, MemoryLimit, Interrupted };

// What may end a computation before it is done. `check` costs some nanoseconds; the clock, the process's memory and
// `poll` are asked for every few milliseconds only.
class Limits {
public:
    using Clock = std::chrono::steady_clock;

    std::optional<Clock::time_point> deadline;
    std::optional<std::size_t> memory_bytes;  // resident memory of the whole process
    std::function<bool()> poll;               // true: the user wants to stop

    // Say whether to stop, and why. Once it says so, it goes on saying so.
    std::optional<StopReason> check() {
        if (reason_ || ++calls_ < calls_until_look_) {
            return reason_;
        }
        return look();
    }

private:
    std::optional<StopReason> look();

    std::optional<StopReason> reason_;
    std::uint32_t calls_ = 0;
    std::uint32_t calls_until_look_ = 1;
    Clock::time_point last_look_{};
    Clock::time_point last_poll_{};
};

// Resident memory of this process, in bytes; 0 where the system does not tell.
std::size_t resident_bytes();

}  // namespace relax

#endif
