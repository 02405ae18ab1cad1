# Lines over what grows, one for each name, in a panel for each of the table's columns after x.
# ARG1: the table, with columns name, linetype and x first; ARG2: title; ARG3: where the figures are from; ARG4: what x is;
# ARG5: the key's title; then each panel's title. One panel alone has logarithmic axes.

csv = ARG1; panels = ARGC - 5

array Name[99]
do for [n = 1:99] { Name[n] = '' }
# A tic for each x of a point: 1000, 16k.
tics = ''
short(x) = gprintf(x < 1e4 ? '%g' : '%.0s%c', x)
note(x) = (Name[column('linetype')] = strcol('name'), tics = tics . sprintf(", '%s' %g", short(x), x), x)
stats csv using (note(column('x'))) nooutput
y(n, p) = column('linetype') == n ? column(3 + p) : NaN

set label 1 ARG3
set xlabel ARG4
if (panels == 1) {
  set xrange [STATS_min / 1.15 : STATS_max * 1.15]
  eval 'set xtics (' . tics[3:] . ')'
  set xtics font ',11'
  set logscale xy
  set title ARG2
  set ylabel ARG6
  set key title ARG5
} else {
  eval 'set terminal svg size 900,420 ' . look
  set xrange [0 : STATS_max * 1.05]
  set yrange [0 : *]
  set multiplot layout 1,panels title ARG2
}
do for [p = 1:panels] {
  if (panels > 1) {
    set title ARGV[5 + p]
    unset key
    if (p == panels) { set key inside bottom right title ARG5 }
  }
  plot for [n = 1:99] csv using (column('x')):(y(n, p)) with linespoints linetype n title Name[n]
  unset label 1
}
