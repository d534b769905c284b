#include "relax/limits.hpp"

#include <algorithm>

#if defined(__linux__)
#include <unistd.h>

#include <cstdio>
#elif defined(__APPLE__)
#include <mach/mach.h>
#endif

namespace relax {

namespace {

constexpr auto kLookInterval = std::chrono::milliseconds(2);
constexpr auto kPollInterval = std::chrono::milliseconds(50);
constexpr std::uint32_t kMostCallsUntilLook = 1U << 14;
// The part of the memory limit that is left for what grows between two looks.
constexpr std::size_t kMemoryReserve = 20;

}  // namespace

std::optional<StopReason> Limits::look() {
    const auto now = Clock::now();
    // Aim at one look every few milliseconds, whatever a call's worth of work costs.
    if (last_look_ != Clock::time_point{} && now - last_look_ < kLookInterval) {
        calls_until_look_ = std::min(calls_until_look_ * 2, kMostCallsUntilLook);
    } else if (last_look_ != Clock::time_point{} && now - last_look_ > 4 * kLookInterval) {
        calls_until_look_ = std::max(calls_until_look_ / 2, 1U);
    }
    calls_ = 0;
    last_look_ = now;
    if (deadline && now >= *deadline) {
        reason_ = StopReason::TimeLimit;
    } else if (now - last_poll_ >= kPollInterval) {
        last_poll_ = now;
        if (poll && poll()) {
            reason_ = StopReason::Interrupted;
        } else if (memory_bytes && resident_bytes() > *memory_bytes - *memory_bytes / kMemoryReserve) {
            reason_ = StopReason::MemoryLimit;
        }
    }
    return reason_;
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
