// Where `kinetome plan` has nothing better: what
//     build/release/bench/stage_rates_bench
// prints on the machine the program is developed on, with nothing else running.
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

[poses]
seconds_per_file = 0.004646
moments_nanoseconds_per_row = 509.6
projection_nanoseconds_per_row = 422.7
accessibility_nanoseconds_per_pair = 2.335
serial_share = 0.1

[[poses.mixture]]
clusters = 30.0
start_nanoseconds_per_row = 86.06
iteration_nanoseconds_per_row = 53.47
letter_nanoseconds_per_row = 50.54

[[poses.mixture]]
clusters = 100.0
start_nanoseconds_per_row = 108.2
iteration_nanoseconds_per_row = 96.92
letter_nanoseconds_per_row = 94.24

[[poses.mixture]]
clusters = 300.0
start_nanoseconds_per_row = 163.2
iteration_nanoseconds_per_row = 174.9
letter_nanoseconds_per_row = 179.7

[[poses.mixture]]
clusters = 1000.0
start_nanoseconds_per_row = 279.5
iteration_nanoseconds_per_row = 416.9
letter_nanoseconds_per_row = 418.5

[[poses.mixture]]
clusters = 3000.0
start_nanoseconds_per_row = 564.9
iteration_nanoseconds_per_row = 1093.0
letter_nanoseconds_per_row = 1059.0

[[poses.mixture]]
clusters = 8000.0
start_nanoseconds_per_row = 1360.0
iteration_nanoseconds_per_row = 3228.0
letter_nanoseconds_per_row = 2696.0
)",
                       "the rates shipped with the program");
}

}  // namespace kinetome
