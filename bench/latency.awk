# Lines of a name in 34 characters, then median, 99 %, 99.9 % and worst in µs, to a table: for each name the median over
# rounds of the first two, and how many times as long it takes as our network alone, and as network and arm.
#   awk -f latency.awk LINES

substr($0, 1, 4) != "step" {
    name = substr($0, 1, 34)
    sub(/ +$/, "", name)
    split(substr($0, 35), value, " ")
    if (!(name in rounds)) names[++count] = name
    middle[name, ++rounds[name]] = value[1]
    late[name, rounds[name]] = value[2]
}

function median(list, name,    n, i, j, t, v) {
    n = rounds[name]
    for (i = 1; i <= n; i++) v[i] = list[name, i] + 0
    for (i = 2; i <= n; i++) for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
    return n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
}

END {
    printf "%-34s %8s %8s  %15s  %17s %7s\n", "step, µs", "median", "p99", "/ network alone", "/ network and arm", "rounds"
    for (k = 1; k <= count; k++) {
        name = names[k]
        us = median(middle, name)
        alone = us / median(middle, "network alone")
        whole = us / median(middle, "network and arm")
        printf "%-34s %8.2f %8.2f  %15.1f  %17.1f %7d\n", name, us, median(late, name), alone, whole, rounds[name]
    }
}
