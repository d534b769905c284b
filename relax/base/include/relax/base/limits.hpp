#ifndef RELAX_BASE_LIMITS_HPP
#define RELAX_BASE_LIMITS_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <optional>

namespace relax {

enum class StopReason : std::uint8_t { TimeLimit, MemoryLimit, Interrupted };

// Thrown where a limit is reached in the middle of something that is of no use unless it is finished: a model, an
// evaluation, an expansion. Each public function of the core turns it into a value.
struct Stopped {
    StopReason reason;
};

// What may end a computation before it is done. Asking costs about a nanosecond; the clock, the process's memory and
// `poll` are looked at every few milliseconds only. Ask before each piece of work that may take a microsecond, and
// again within a piece that may take more than a few milliseconds: the clock is read at every sixteenth question.
class Limits {
public:
    using Clock = std::chrono::steady_clock;

    std::optional<Clock::time_point> deadline;
    std::optional<std::uint64_t> steps;       // questions: a time limit that is the same on every machine
    std::optional<std::size_t> memory_bytes;  // resident memory of the whole process
    std::function<bool()> poll;               // true: the user wants to stop

    // Say whether to stop, and why. Once it says so, it goes on saying so.
    std::optional<StopReason> check() {
        if (++calls_ < kCallsUntilClock && !reason_) {
            return std::nullopt;
        }
        calls_ = 0;
        return look();
    }

    // The same by exception.
    void stop_if_reached() {
        if (const auto reason = check()) {
            throw Stopped{*reason};
        }
    }

    // While one lives, there is a little more time, and memory, to put together what was found before a limit was
    // reached, or the user wanted to stop. A second Ctrl-C ends that, too.
    class Grace {
    public:
        explicit Grace(Limits& limits);
        ~Grace();
        Grace(const Grace&) = delete;
        Grace& operator=(const Grace&) = delete;

    private:
        Limits& limits_;
        std::optional<Clock::time_point> deadline_;
        std::optional<std::uint64_t> steps_;
        std::optional<std::size_t> memory_bytes_;
        std::optional<StopReason> reason_;
    };

private:
    static constexpr std::uint32_t kCallsUntilClock = 16;

    std::optional<StopReason> look();

    std::optional<StopReason> reason_;
    std::uint32_t calls_ = kCallsUntilClock;
    std::uint64_t looks_ = 0;
    Clock::time_point last_look_{};
    Clock::time_point last_poll_{};
};

// Run something that a limit may end. Returns why it was ended, or what it returns itself.
template <typename Run>
std::optional<StopReason> run_within_limits(Run run) {
    try {
        return run();
    } catch (const Stopped& stopped) {
        return stopped.reason;
    } catch (const std::bad_alloc&) {
        return StopReason::MemoryLimit;
    }
}

// Resident memory of this process, in bytes; 0 where the system does not tell.
std::size_t resident_bytes();

}  // namespace relax

#endif
