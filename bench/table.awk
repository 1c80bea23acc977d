# Lines such as `acm-1t cfc B=64 T=50 wall min 2.9 med 3.0 ms | cpu min 2.8 med 2.9 ms | …` to a table: for each network
# and batch the median over rounds of each program's smallest time, and how many times as long it takes as acm.
#   awk -f table.awk time=cpu LINES

$3 ~ /^B=/ {
    split($2, name, "-")
    kind = name[1]
    program = $1 ($2 == kind ? "" : " " $2)
    batch = substr($3, 3)
    at = 0
    for (i = 1; i <= NF; i++) if ($i == time) at = i
    key = kind " " batch
    if (!(key in known)) { known[key]; keys[++count] = key }
    if (!((key, program) in rounds)) list[key] = list[key] "|" program
    times[key, program, ++rounds[key, program]] = $(at + 2)
}

function median(key, program,    n, i, j, t, v) {
    n = rounds[key, program]
    for (i = 1; i <= n; i++) v[i] = times[key, program, i] + 0
    for (i = 2; i <= n; i++) for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
    return n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
}

END {
    printf "%-6s %5s  %-28s %10s %8s %7s\n", "kind", "batch", "program", "ms (" time ")", "ratio", "rounds"
    for (k = 1; k <= count; k++) {
        n = split(list[keys[k]], programs, "|")
        split(keys[k], part, " ")
        own = median(keys[k], programs[2])
        for (p = 2; p <= n; p++) {
            ms = median(keys[k], programs[p])
            printf "%-6s %5s  %-28s %10.3f %8.2f %7d\n", part[1], part[2], programs[p], ms, ms / own, rounds[keys[k], programs[p]]
        }
    }
}
