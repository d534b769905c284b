#include "relax/base/limits.hpp"

#include <utility>

#if defined(__linux__)
#include <unistd.h>

#include <cstdio>
#include <ctime>
#elif defined(__APPLE__)
#include <mach/mach.h>
#endif

namespace relax {

namespace {

constexpr auto kLookInterval = std::chrono::milliseconds(4);
constexpr auto kPollInterval = std::chrono::milliseconds(50);
constexpr auto kGrace = std::chrono::milliseconds(500);  // plans of a million tasks are traced in that time
// The part of the memory limit that is left for what grows between two looks.
constexpr std::size_t kMemoryReserve = 20;

// The time to some milliseconds, in a fraction of what the exact time costs.
Limits::Clock::time_point coarse_now() {
#if defined(__linux__)
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    return Limits::Clock::time_point(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
#else
    return Limits::Clock::now();
#endif
}

}  // namespace

std::optional<StopReason> Limits::look() {
    if (steps && ++looks_ * kCallsUntilClock > *steps) {
        reason_ = StopReason::TimeLimit;
    }
    const auto now = coarse_now();
    if (reason_ || now - last_look_ < kLookInterval) {
        return reason_;
    }
    last_look_ = now;
    if (deadline && now >= *deadline) {
        reason_ = StopReason::TimeLimit;
    } else if (memory_bytes && resident_bytes() > *memory_bytes - *memory_bytes / kMemoryReserve) {
        reason_ = StopReason::MemoryLimit;
    } else if (now - last_poll_ >= kPollInterval) {
        last_poll_ = now;
        if (poll && poll()) {
            reason_ = StopReason::Interrupted;
        }
    }
    return reason_;
}

Limits::Grace::Grace(Limits& limits)
    : limits_(limits),
      deadline_(limits.deadline),
      steps_(std::exchange(limits.steps, std::nullopt)),
      memory_bytes_(limits.memory_bytes),
      reason_(limits.reason_) {
    const auto until = Clock::now() + kGrace;
    if (reason_ || (deadline_ && *deadline_ < until)) {
        limits.deadline = until;
    }
    if (memory_bytes_) {
        *limits.memory_bytes += *memory_bytes_ / kMemoryReserve;
    }
    limits.reason_.reset();
}

Limits::Grace::~Grace() {
    limits_.deadline = deadline_;
    limits_.steps = steps_;
    limits_.memory_bytes = memory_bytes_;
    limits_.reason_ = reason_;
}

#if defined(__linux__)
std::size_t resident_bytes() {
    std::size_t pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        unsigned long total = 0;
        unsigned long resident = 0;
        if (std::fscanf(file, "%lu %lu", &total, &resident) == 2) {
            pages = resident;
        }
        std::fclose(file);
    }
    return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}
#elif defined(__APPLE__)
std::size_t resident_bytes() {
    mach_task_basic_info info{};
    mach_msg_type_number_t count = MACH_TASK_BASIC_INFO_COUNT;
    const auto result = task_info(mach_task_self(), MACH_TASK_BASIC_INFO, reinterpret_cast<task_info_t>(&info), &count);
    return result == KERN_SUCCESS ? info.resident_size : 0;
}
#else
std::size_t resident_bytes() { return 0; }
#endif

}  // namespace relax
