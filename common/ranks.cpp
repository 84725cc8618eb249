#include "common/ranks.hpp"

#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace common::mpi {

namespace {

// What MPI is asked once, where the program starts.
struct Here {
    int rank = 0, count = 1, on_machine = 1;
    bool writes = true;
    int error_stream = STDERR_FILENO;  // kept for the message of a rank that fails alone
    MPI_Comm last = MPI_COMM_NULL;     // on which ranks meet at the end
    double communication = 0;
} here;

// Adds the time from here to the end of a block.
struct Watch {
    double start = MPI_Wtime();
    ~Watch() { here.communication += MPI_Wtime() - start; }
};

int as_int(std::size_t count) {
    if (count > std::size_t(std::numeric_limits<int>::max()))
        throw std::length_error("more numbers than one message of MPI holds: use more ranks");
    return int(count);
}

constexpr std::size_t piece_bytes = 1 << 20;

}  // namespace

int rank() { return here.rank; }
int rank_count() { return here.count; }
int ranks_here() { return here.on_machine; }
bool writes() { return here.writes; }
double communication_seconds() { return here.communication; }

// A rank of Open MPI that waits gives its core away, as threads do (share_cores), unless the user says otherwise.
void start() {
    int level = 0;
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &here.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &here.count);
    MPI_Comm_dup(MPI_COMM_WORLD, &here.last);
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &here.on_machine);
    MPI_Comm_free(&machine);
    std::atexit([] {
        int over = 0;
        if (MPI_Finalized(&over); over == 0) MPI_Finalize();
    });
    here.writes = here.rank == 0;
    if (here.writes) return;
    here.error_stream = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
}

// The others may have failed with the same message, so a rank that has failed waits for them before it ends
// all. The first rank waits least, because it has printed that message already.
int end(int status, const std::string& message, const std::function<void()>& alone) {
    const bool failed = status == 2 || status == 3;
    const double until = MPI_Wtime() + (failed ? 2 + 0.1 * std::min(here.rank, 10) : 1e9);
    MPI_Request meeting;
    MPI_Ibarrier(here.last, &meeting);
    for (int met = 0; MPI_Test(&meeting, &met, MPI_STATUS_IGNORE), met == 0;) {
        if (MPI_Wtime() > until) {
            if (here.rank > 0) {
                dprintf(here.error_stream, "%s\n", message.c_str());
                here.writes = true;
                alone();
            }
            MPI_Abort(MPI_COMM_WORLD, status);
        }
        usleep(1000);
    }
    return status;
}

void sum(std::span<long> numbers) {
    const Watch watch;
    MPI_Allreduce(MPI_IN_PLACE, numbers.data(), as_int(numbers.size()), MPI_LONG, MPI_SUM,
                  MPI_COMM_WORLD);
}

long largest(long number) {
    const Watch watch;
    MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_LONG, MPI_MAX, MPI_COMM_WORLD);
    return number;
}

void gather_pieces(double* all, std::span<const long> first) {
    const Watch watch;
    std::vector<int> begin, count;
    for (int k = 0; k < here.count; ++k) {
        begin.push_back(as_int(std::size_t(first[k])));
        count.push_back(as_int(std::size_t(first[k + 1] - first[k])));
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DOUBLE, all, count.data(), begin.data(), MPI_DOUBLE,
                   MPI_COMM_WORLD);
}

void exchange(std::span<const int> peers, const std::vector<std::vector<double>>& to,
              std::vector<std::vector<double>>& from) {
    const Watch watch;
    std::vector<MPI_Request> sent(peers.size());
    for (std::size_t k = 0; k < peers.size(); ++k)
        MPI_Isend(to[k].data(), as_int(to[k].size()), MPI_DOUBLE, peers[k], 0, MPI_COMM_WORLD,
                  &sent[k]);
    from.resize(peers.size());
    for (std::size_t k = 0; k < peers.size(); ++k) {
        MPI_Message message;
        MPI_Status status;
        int count = 0;
        MPI_Mprobe(peers[k], 0, MPI_COMM_WORLD, &message, &status);
        MPI_Get_count(&status, MPI_DOUBLE, &count);
        from[k].resize(std::size_t(count));
        MPI_Mrecv(from[k].data(), count, MPI_DOUBLE, &message, MPI_STATUS_IGNORE);
    }
    MPI_Waitall(int(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
}

void gather_in_turn(const void* own, std::size_t bytes,
                    const std::function<void(const void*, std::size_t)>& take) {
    const auto send = [](const void* from, std::size_t count) {
        const Watch watch;
        MPI_Send(from, int(count), MPI_BYTE, 0, 1, MPI_COMM_WORLD);
    };
    const auto receive = [](void* to, std::size_t count, int from) {
        const Watch watch;
        MPI_Recv(to, int(count), MPI_BYTE, from, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    };
    if (here.rank > 0) {
        send(&bytes, sizeof bytes);
        for (std::size_t done = 0; done < bytes; done += piece_bytes)
            send(static_cast<const char*>(own) + done, std::min(piece_bytes, bytes - done));
        return;
    }
    take(own, bytes);
    std::vector<char> piece(piece_bytes);
    for (int k = 1; k < here.count; ++k) {
        receive(&bytes, sizeof bytes, k);
        for (std::size_t done = 0; done < bytes; done += piece_bytes) {
            const std::size_t part = std::min(piece_bytes, bytes - done);
            receive(piece.data(), part, k);
            take(piece.data(), part);
        }
    }
}

void in_turn(void* numbers, std::size_t size, std::span<const long> first,
             const std::function<void(long)>& work) {
    const auto begin = [&](std::size_t k) {
        return static_cast<char*>(numbers) + std::size_t(first[k]) * size;
    };
    const std::size_t pieces = first.size() - 1;
    const int last = here.count - 1;
    std::vector<MPI_Request> sent(here.rank < last ? pieces : 0);
    for (std::size_t k = 0; k < pieces; ++k) {
        const int bytes = as_int(std::size_t(begin(k + 1) - begin(k)));
        if (here.rank > 0) {
            const Watch watch;
            MPI_Recv(begin(k), bytes, MPI_BYTE, here.rank - 1, 2, MPI_COMM_WORLD,
                     MPI_STATUS_IGNORE);
        }
        work(long(k));
        const Watch watch;
        if (here.rank < last)
            MPI_Isend(begin(k), bytes, MPI_BYTE, here.rank + 1, 2, MPI_COMM_WORLD, &sent[k]);
    }
    const Watch watch;
    MPI_Waitall(int(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
    for (std::size_t k = 0; k < pieces; ++k)
        MPI_Bcast(begin(k), int(begin(k + 1) - begin(k)), MPI_BYTE, last, MPI_COMM_WORLD);
}

}  // namespace common::mpi
