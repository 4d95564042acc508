#include "kinetome/base/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

using namespace kinetome;

TEST_CASE("a loop visits every item once, for any number of threads") {
    for (const int threads : {1, 2, 3, 7}) {
        for (const int64_t count : {0, 1, 2, 1000}) {
            std::vector<std::atomic<int>> visits(static_cast<size_t>(count));
            parallel_for(threads, count, [&](int64_t i) { ++visits[static_cast<size_t>(i)]; });
            for (const auto& visit : visits) REQUIRE(visit == 1);
        }
    }
}

TEST_CASE("a loop uses the threads it was given") {
    std::atomic<int> arrived{0}, met{0};
    parallel_for(2, 2, [&](int64_t) {
        ++arrived;
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (arrived < 2 && std::chrono::steady_clock::now() < deadline)
            std::this_thread::yield();
        met += arrived == 2;
    });
    CHECK(met == 2);
}

TEST_CASE("the exception that leaves a loop is the one a single thread would meet first") {
    for (const int threads : {1, 2, 3, 7}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            const auto body = [](int64_t i) {
                if (i == 37) std::this_thread::sleep_for(std::chrono::milliseconds(2));
                if (i == 37 || i == 38 || i == 41) throw std::runtime_error(std::to_string(i));
            };
            CHECK_THROWS_WITH(parallel_for(threads, 100, body), "37");
        }
    }
}

TEST_CASE("after an exception no further item starts") {
    constexpr int64_t count = 100'000;
    for (const int threads : {1, 2, 3, 7}) {
        std::atomic<int64_t> started{0};
        const auto body = [&](int64_t i) {
            ++started;
            if (i == 5) throw std::runtime_error("five");
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        };
        CHECK_THROWS_WITH(parallel_for(threads, count, body), "five");
        CHECK(started < 1000);
    }
}

TEST_CASE("a loop works again after one that threw") {
    CHECK_THROWS(parallel_for(3, 10, [](int64_t) { throw std::runtime_error("no"); }));
    std::atomic<int64_t> sum{0};
    parallel_for(3, 10, [&](int64_t i) { sum += i; });
    CHECK(sum == 45);
}
