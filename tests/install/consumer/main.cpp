// Prints the letters of a store as `kinetome export STORE letters` does.
#include <iostream>

#include "kinetome/formats/asf_amc.h"
#include "kinetome/models/pose_clusters.h"
#include "kinetome/stages/export.h"
#include "kinetome/stages/open_store.h"

int main(int, char** arguments) {
    const kinetome::OpenStore open(arguments[1]);
    std::cout << kinetome::write_table(kinetome::letter_table(open.generation),
                                       kinetome::TableFormat::csv);
}
