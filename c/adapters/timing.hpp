// How the programs that measure adapters take times.
#ifndef TIMING_HPP
#define TIMING_HPP

#include <algorithm>
#include <ctime>
#include <vector>

/// The processor time of this thread in milliseconds.
inline double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

/// The median of at least one time.
inline double median(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

#endif
