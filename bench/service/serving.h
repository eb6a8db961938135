#pragma once

namespace alvor::bench {

/// Runs a server on a free port and prints its address. Instead of solving, its solves do a fixed amount of arithmetic per shot
/// and publish a hundred thousand leaves ten times a second, a fifth of them changed, for `seconds`: so the measured cost does
/// not depend on the light. Ends when it is killed.
int serve(double seconds);

}  // namespace alvor::bench
