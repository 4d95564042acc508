// Where `kinetome plan` has nothing better. Measured on two threads of a quiet machine by
//     build/release/bench/stage_rates_bench --frames 100000
#include "kinetome/stages/rates.h"

namespace kinetome {

Rates shipped_rates() {
    return parse_rates(R"(
machine = 'AMD EPYC'
version = '0.1.0'
threads = 2

[frames]
seconds_per_file = 0.002337
nanoseconds_per_value = 17.0
serial_share = 0.1763

[features]
seconds_per_file = 0.003139
nanoseconds_per_value = 12.43
serial_share = 0.2338

[pose_hierarchy]
seconds_per_file = 0.003966
nanoseconds_per_value = 1636.0
serial_share = 0.08384

[signatures]
seconds_per_file = 0.004205
nanoseconds_per_value = 666.8
serial_share = 0.5231

[neighbors]
seconds_per_file = 0.002092
nanoseconds_per_value = 45.38
serial_share = 0.06572

[corpus_neighbors]
seconds_per_file = 0.002729
nanoseconds_per_value = 131.0
serial_share = 0.1747

[search]
nanoseconds_per_row = 206.3

[bundles]
seconds_per_file = 0.003796
nanoseconds_per_value = 906.8
serial_share = 0.9899

[bundle_graph]
seconds_per_file = 0.001879
nanoseconds_per_value = 1.922e+04
serial_share = 0.0

[segments]
seconds_per_file = 0.002589
nanoseconds_per_value = 6384.0
serial_share = 0.112

[primitives]
seconds_per_file = 0.003423
nanoseconds_per_value = 8347.0
serial_share = 0.05727

[poses]
seconds_per_file = 0.002552
moments_nanoseconds_per_row = 406.9
projection_nanoseconds_per_row = 322.2
accessibility_nanoseconds_per_pair = 1.636
serial_share = 0.02963

[[poses.mixture]]
clusters = 30.0
start_nanoseconds_per_row = 223.6
iteration_nanoseconds_per_row = 44.8
letter_nanoseconds_per_row = 42.11

[[poses.mixture]]
clusters = 100.0
start_nanoseconds_per_row = 223.6
iteration_nanoseconds_per_row = 81.42
letter_nanoseconds_per_row = 76.54

[[poses.mixture]]
clusters = 300.0
start_nanoseconds_per_row = 223.6
iteration_nanoseconds_per_row = 144.3
letter_nanoseconds_per_row = 143.3

[[poses.mixture]]
clusters = 1000.0
start_nanoseconds_per_row = 254.0
iteration_nanoseconds_per_row = 350.7
letter_nanoseconds_per_row = 341.6

[[poses.mixture]]
clusters = 3000.0
start_nanoseconds_per_row = 494.9
iteration_nanoseconds_per_row = 860.6
letter_nanoseconds_per_row = 839.2

[[poses.mixture]]
clusters = 8000.0
start_nanoseconds_per_row = 723.6
iteration_nanoseconds_per_row = 2132.0
letter_nanoseconds_per_row = 2105.0
)",
                       "the rates shipped with the program");
}

}  // namespace kinetome
