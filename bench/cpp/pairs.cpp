// How Rust owns and reads the pairs.
#include "libraries.h"

extern "C" Pairs *bench_pairs_new() { return new Pairs; }

extern "C" void bench_pairs_delete(Pairs *pairs) { delete pairs; }

extern "C" void bench_pairs_clear(Pairs *pairs) { pairs->clear(); }

extern "C" std::size_t bench_pairs_count(const Pairs *pairs) { return pairs->size(); }

extern "C" const std::uint32_t *bench_pairs_data(const Pairs *pairs) {
    return pairs->empty() ? nullptr : pairs->front().data();
}
