// visibility_reduce.comp: adds up what the work groups of visibility_gather.comp have left, in double precision
//   in   i_sums     [group][entry]
//   out  io_totals  [entry], added to unless u_first
// A column of invocations per entry: each adds every 16th group, then the first one adds up the column, always in the
// same order.
const int kAcross = 16, kDown = 16;
layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = 5, std430) readonly buffer Sums { float i_sums[]; };
layout(binding = 6, std430) buffer Totals { double io_totals[]; };
layout(location = 0) uniform int u_entries;
layout(location = 1) uniform int u_groups;
layout(location = 2) uniform bool u_first;

shared double s_part[kDown][kAcross];

void main() {
    int entry = int(gl_GlobalInvocationID.x), x = int(gl_LocalInvocationID.x), y = int(gl_LocalInvocationID.y);
    double sum = 0.0LF;
    if (entry < u_entries)
        for (int group = y; group < u_groups; group += kDown) sum += double(i_sums[group * u_entries + entry]);
    s_part[y][x] = sum;
    barrier();
    if (y > 0 || entry >= u_entries) return;
    for (int i = 1; i < kDown; ++i) sum += s_part[i][x];
    io_totals[entry] = u_first ? sum : io_totals[entry] + sum;
}
