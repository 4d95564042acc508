// Where `kinetome plan` has nothing better. Measured on two threads by
//     build/release/bench/stage_rates_bench
// but for the serial shares, which were not measurable on a machine that was busy then: they are
// rounded from the clock of quiet runs over 331,893 real frames.
#include "kinetome/stages/rates.h"

namespace kinetome {

Rates shipped_rates() {
    return parse_rates(R"(
machine = 'AMD EPYC'
version = '0.1.0'
threads = 2

[frames]
seconds_per_file = 0.00802
nanoseconds_per_value = 20.78
serial_share = 0.3

[features]
seconds_per_file = 0.01237
nanoseconds_per_value = 15.44
serial_share = 0.5

[pose_hierarchy]
seconds_per_file = 0.005
nanoseconds_per_value = 1800.0
serial_share = 0.1

[signatures]
seconds_per_file = 0.004
nanoseconds_per_value = 2000.0
serial_share = 0.3

[neighbors]
seconds_per_file = 0.003
nanoseconds_per_value = 60.0
serial_share = 0.1

[corpus_neighbors]
seconds_per_file = 0.01
nanoseconds_per_value = 140.0
serial_share = 0.1

[search]
nanoseconds_per_row = 300.0

[bundles]
seconds_per_file = 0.005
nanoseconds_per_value = 3000.0
serial_share = 0.8

[bundle_graph]
seconds_per_file = 0.005
nanoseconds_per_value = 15000.0
serial_share = 1.0

[segments]
seconds_per_file = 0.005
nanoseconds_per_value = 20000.0
serial_share = 0.1

[primitives]
seconds_per_file = 0.005
nanoseconds_per_value = 30000.0
serial_share = 0.2

[poses]
seconds_per_file = 0.004646
moments_nanoseconds_per_row = 509.6
projection_nanoseconds_per_row = 422.7
accessibility_nanoseconds_per_pair = 2.335
serial_share = 0.1

[[poses.mixture]]
clusters = 30.0
start_nanoseconds_per_row = 119.4
iteration_nanoseconds_per_row = 50.42
letter_nanoseconds_per_row = 49.93

[[poses.mixture]]
clusters = 100.0
start_nanoseconds_per_row = 182.3
iteration_nanoseconds_per_row = 94.6
letter_nanoseconds_per_row = 87.4

[[poses.mixture]]
clusters = 300.0
start_nanoseconds_per_row = 210.3
iteration_nanoseconds_per_row = 182.3
letter_nanoseconds_per_row = 179.1

[[poses.mixture]]
clusters = 1000.0
start_nanoseconds_per_row = 483.5
iteration_nanoseconds_per_row = 470.8
letter_nanoseconds_per_row = 496.6

[[poses.mixture]]
clusters = 3000.0
start_nanoseconds_per_row = 842.7
iteration_nanoseconds_per_row = 1305.0
letter_nanoseconds_per_row = 1188.0

[[poses.mixture]]
clusters = 8000.0
start_nanoseconds_per_row = 1554.0
iteration_nanoseconds_per_row = 2887.0
letter_nanoseconds_per_row = 3062.0
)",
                       "the rates shipped with the program");
}

}  // namespace kinetome
