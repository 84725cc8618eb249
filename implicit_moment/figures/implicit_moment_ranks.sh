#!/bin/sh
# implicit_moment_ranks.sh FOLDER: what ranks are worth, from pieces that were measured (data/ranks_pieces.csv). Seconds of a step on n cores, one rank on each:
#
#     T(n) = particle N f(n)/n + mesh M + gather M (1/network + min(n, node)/memory) + latency (log2 n + 4),    efficiency = T(1)/n T(n)
#
# N particles on M cells; f, the most particles of a rank over the mean; every rank has the whole mesh, so that each core of a node gets and steps all of it.
# explicit_em has strips of four rows of cells, implicit_moment rows of nodes, two at least. What would be next: patches in both directions, M/n cells to a rank.
#     efficiency.dat  cores, and for each run the efficiency, and that with patches
#     balance.dat     ranks, and f at t Omega_ci = 0, 15 and 30, and at 15 and 30 with the borders of t = 0
set -eu
export LC_ALL=C.UTF-8
mkdir -p "$1"
awk -F, -v balance="$1/balance.dat" -v efficiency="$1/efficiency.dat" '
    # The most of a rank over the mean, with these borders. in: share[strip]
    function imbalance(share, ranks, first,    k, s, sum, most) {
        for (k = 0; k < ranks; k++) {
            sum = 0
            for (s = first[k]; s < first[k + 1]; s++) sum += share[s]
            if (sum > most) most = sum
        }
        return most * ranks
    }
    # Fills ranks, of at least few strips each, up to a bound, and gives the most of one; cut() finds the least bound, as Division::of of division.hpp does.
    function fill(share, strips, ranks, few, bound, first,    k, s, sum, most) {
        first[0] = k = sum = most = 0
        for (s = 0; s < strips; s++) {
            if (s >= first[k] + few && k < ranks - 1 && (sum + share[s] > bound || strips - s <= few * (ranks - 1 - k))) { first[++k] = s; sum = 0 }
            sum += share[s]
            if (sum > most) most = sum
        }
        first[ranks] = strips
        return most
    }
    function cut(share, strips, ranks, few, first,    s, low, high, bound) {
        low = 0; high = 1.01
        for (s = 0; s < strips; s++) if (share[s] > low) low = share[s]
        while (high - low > 1e-9) { bound = (low + high) / 2; if (fill(share, strips, ranks, few, bound, first) <= bound) high = bound; else low = bound }
        fill(share, strips, ranks, few, high, first)
    }
    BEGIN { strips = 0 }
    /^#/ { next }
    FILENAME ~ /strips/ { t0[strips] = $1; t15[strips] = $2; t30[strips] = $3; strips++; next }
    { piece[$1] = $2 }
    # T on n cores. in: names of the pieces, N, M, f, bytes that all get per cell
    function step_time(kind, N, M, f, n, gather) {
        if (n == 1) return piece["particle_" kind] * N + piece["mesh_" kind] * M
        return piece["particle_" kind] * N * f / n + piece["mesh_" kind] * M \
            + gather * M * ((n > piece["cores_of_node"] ? 1 / piece["network"] : 0) \
                + (n < piece["cores_of_node"] ? n : piece["cores_of_node"]) / piece["memory"]) + piece["latency"] * (log(n) / log(2) + 4)
    }
    # In patches of equal work: the rims, two cells wide, go to eight neighbors; and in each iteration of a solver twice all of a patch goes to
    # those of its row, for the transforms, and sums go to all.
    function patch_time(kind, N, M, n, gather, iterations,    of_core) {
        if (n == 1) return step_time(kind, N, M, 1, 1, gather)
        of_core = (n > piece["cores_of_node"] ? piece["network"] : piece["memory"]) / piece["cores_of_node"]
        return (piece["particle_" kind] * N + piece["mesh_" kind] * M) / n + 8 * piece["latency"] + 8 * sqrt(M / n) * gather / of_core \
            + iterations * 2 * (24 * M / n / of_core + piece["latency"] * (sqrt(n) + log(n) / log(2)))
    }
    END {
        print "ranks t0 t15 t30 t15_borders_of_t0 t30_borders_of_t0" > balance
        for (n = 1; n <= strips; n++) {
            cut(t0, strips, n, 1, first)
            a = imbalance(t0, n, first); d = imbalance(t15, n, first); e = imbalance(t30, n, first)
            cut(t15, strips, n, 1, first); b = imbalance(t15, n, first)
            cut(t30, strips, n, 1, first); c = imbalance(t30, n, first)
            print n, a, b, c, d, e > balance
        }
        # The large run has the same plasma on eight times as many strips.
        for (s = 0; s < 8 * strips; s++) fine[s] = t15[int(s / 8)] / 8
        print "cores slide slide_patches large large_patches implicit implicit_patches" > efficiency
        for (x = 0; x <= 52; x++) {
            n = int(10 ^ (x / 13) + 0.5)
            if (n == last) continue
            last = n
            line = n
            split("9.12e6 1e10 2e5", N, " "); split("131072 8388608 4096", M, " "); split("64 512 32", most, " ")
            split("explicit explicit implicit", kind, " "); split("24 24 304", gather, " "); split("0 0 8", iterations, " ")
            for (r = 1; r <= 3; r++) {
                one = step_time(kind[r], N[r], M[r], 1, 1, gather[r])
                f = 0
                if (n <= most[r]) {
                    if (r == 2) { cut(fine, 512, n, 1, first); f = imbalance(fine, n, first) } else { cut(t15, 64, n, r == 3 ? 2 : 1, first); f = imbalance(t15, n, first) }
                }
                line = line " " (f ? one / n / step_time(kind[r], N[r], M[r], f, n, gather[r]) : "nan") " " one / n / patch_time(kind[r], N[r], M[r], n, gather[r], iterations[r])
            }
            print line > efficiency
        }
    }' implicit_moment/data/explicit_gem_strips.csv implicit_moment/data/ranks_pieces.csv
