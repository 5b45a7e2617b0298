// tanktread [options] deck.yaml [overlay.yaml ...]

#include "app/program.hpp"

int main(int argc, char** argv) { return tanktread::main(argc, argv); }
