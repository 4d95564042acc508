// Dense parallel loops (OpenMP): an exception leaves a loop as on one thread. Irregular work
// (files, clips) goes to oneTBB instead, never one inside the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kinetome {

/// Runs worker() on `threads` threads at once, this one among them; it must not throw.
template <class Worker>
void run_team(int threads, const Worker& worker) {
#ifdef __SANITIZE_THREAD__
    // The thread sanitizer cannot see libgomp's barriers and would report every loop.
    std::vector<std::jthread> team;
    for (int t = 1; t < threads; ++t) team.emplace_back([&worker] { worker(); });
    worker();
#else
#pragma omp parallel num_threads(threads)
    worker();
#endif
}

/// Calls body(i) for i in [0, count), items handed out in order to `threads` threads. After a throw
/// no further item starts; the exception of the lowest index is rethrown. All items before that one
/// have run, so it is the exception a single thread would have met.
template <class Body>
void parallel_for(int threads, int64_t count, Body&& body) {
    if (threads <= 1 || count <= 1) {
        for (int64_t i = 0; i < count; ++i) body(i);
        return;
    }
    std::atomic<int64_t> next{0};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    std::exception_ptr error;
    int64_t error_index = count;
    run_team(static_cast<int>(std::min<int64_t>(threads, count)), [&] {
        while (!failed.load(std::memory_order_relaxed)) {
            const int64_t i = next.fetch_add(1, std::memory_order_relaxed);
            if (i >= count) break;
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (i < error_index) {
                    error_index = i;
                    error = std::current_exception();
                }
                failed = true;
            }
        }
    });
    if (error) std::rethrow_exception(error);
}

}  // namespace kinetome
