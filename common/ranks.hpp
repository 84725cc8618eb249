// Several processes, the ranks of MPI, that take the steps of one case together, on one machine or on
// many. All MPI of the project lives here and in ranks.cpp; a program built without it has one rank.
//
// Every rank goes through the same program with the same case, and does what concerns the mesh and the
// records as one process would; only particles are divided. So all ranks make the same calls and take the
// same decisions. Only the first rank prints and writes files.
//
// The bytes are those of one process because the sums are the same sums: a number is added where, and in
// the order in which, one process adds it, and what crosses a border are the terms, or what has come out
// so far, never a sum of a rank's own.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace common {

/// Whether the program was built with `make MPI=1`.
inline constexpr bool has_ranks = RANKS;

namespace mpi {  // what ranks.cpp does for those that have ranks

int rank();
int rank_count();
int ranks_here();
double communication_seconds();
void start();
bool writes();
int end(int status, const std::string& message, const std::function<void()>& alone);
void sum(std::span<long> numbers);
long largest(long number);
void gather_pieces(double* all, std::span<const long> first);
void exchange(std::span<const int> peers, const std::vector<std::vector<double>>& to,
              std::vector<std::vector<double>>& from);
void gather_in_turn(const void* own, std::size_t bytes,
                    const std::function<void(const void*, std::size_t)>& take);
void in_turn(void* numbers, std::size_t size, std::span<const long> first,
             const std::function<void(long)>& work);

}  // namespace mpi

/// Which of the ranks this process is, how many there are, and how many of them share its machine.
inline int rank() { return has_ranks ? mpi::rank() : 0; }
inline int rank_count() { return has_ranks ? mpi::rank_count() : 1; }
inline int ranks_here() { return has_ranks ? mpi::ranks_here() : 1; }
/// Whether this process prints and writes the files: the first rank, until another has failed alone.
inline bool is_first_rank() { return has_ranks ? mpi::writes() : true; }
/// The time that this rank has given to others or waited for them so far.
inline double communication_seconds() { return has_ranks ? mpi::communication_seconds() : 0; }

/// Starts MPI, at the beginning of main; from here on only the first rank prints.
inline void start_ranks() {
    if (has_ranks) mpi::start();
}
/// The end of main. Waits until all ranks are there. A rank that has failed waits two seconds, and then
/// prints its message, writes what is to be written in place of the first one, and ends all.
/// in: the status, that message and what writes. out: the status
inline int end_ranks(
    int status, const std::string& message = "", const std::function<void()>& alone = [] {}) {
    return has_ranks ? mpi::end(status, message, alone) : status;
}

/// Sums over all ranks, place by place; exact, since the numbers are whole.
inline void sum_over_ranks(std::span<long> numbers) {
    if (has_ranks) mpi::sum(numbers);
}
inline long sum_over_ranks(long number) {
    sum_over_ranks(std::span(&number, 1));
    return number;
}
/// One of `parts` parts of a list, contiguous and even to one number; by default all of it.
struct Share {
    long part = 0, parts = 1;

    long begin(long count) const { return count * part / parts; }
    long end(long count) const { return count * (part + 1) / parts; }
};
inline Share share_of_rank() { return {rank(), rank_count()}; }

/// The largest of the numbers of all ranks; nobody goes on before all have come here.
inline long largest_over_ranks(long number) { return has_ranks ? mpi::largest(number) : number; }

/// Gives every rank the pieces of all. in/out: all; rank r has made the numbers from first[r] to first[r + 1]
inline void gather_pieces(double* all, std::span<const long> first) {
    if (has_ranks) mpi::gather_pieces(all, first);
}

/// Gives to[k] to the rank peers[k] and takes from[k] from it, which calls it with this rank as a peer.
inline void exchange(std::span<const int> peers, const std::vector<std::vector<double>>& to,
                     std::vector<std::vector<double>>& from) {
    if (has_ranks) mpi::exchange(peers, to, from);
}

/// Hands the bytes of all ranks to the first one, piece by piece, in the order of the ranks: take(piece,
/// bytes) is called by the first rank alone.
inline void gather_in_turn(const void* own, std::size_t bytes,
                           const std::function<void(const void*, std::size_t)>& take) {
    has_ranks ? mpi::gather_in_turn(own, bytes, take) : take(own, bytes);
}

/// The numbers of all ranks one after the other, with the first rank; the others get none.
inline std::vector<double> gather_in_turn(const std::vector<double>& own) {
    std::vector<double> all;
    gather_in_turn(own.data(), own.size() * sizeof(double),
                   [&](const void* piece, std::size_t bytes) {
                       const double* from = static_cast<const double*>(piece);
                       all.insert(all.end(), from, from + bytes / sizeof(double));
                   });
    return all;
}

/// The ranks take turns at numbers, piece by piece: each works on what the one before has left there.
/// In the end all have what the last one has left.
/// in: first, where the pieces begin, one more for the end; work(piece)
template <class Number>
void in_turn(Number* numbers, std::span<const long> first, const std::function<void(long)>& work) {
    static_assert(std::is_trivially_copyable_v<Number>);
    if (has_ranks) return mpi::in_turn(numbers, sizeof(Number), first, work);
    for (long k = 0; k + 1 < std::ssize(first); ++k) work(k);
}

/// Numbers of the particles, of which each rank has some, in the order of the ranks: what an archive
/// that writes takes for one list. One that reads leaves each rank its share.
template <class Number>
struct OfAllRanks {
    std::vector<Number>& values;
    Share share = {};
};
/// Where the parts of a list begin, as each rank counts its own; in one list, the sum of all counts.
struct SumOverRanks {
    std::vector<int>& values;
};

}  // namespace common
