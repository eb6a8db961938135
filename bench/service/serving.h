#pragma once

namespace alvor::bench {

/// A server on a free port, whose address it prints. Its solves shoot a fixed work and publish a hundred thousand leaves ten
/// times a second, a fifth of them changed, for so many seconds: what they cost does not depend on how light goes. Ends when it
/// is killed.
int serve(double seconds);

}  // namespace alvor::bench
