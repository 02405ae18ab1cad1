# How the work scales over devices (the paper's Figure 7), a line for each set of devices:
#   gnuplot tools/plot/style.gp -c tools/plot/scale.gp docs/scaling/sampled.csv 'Teapots among boxes' 'two H100' > sampled.svg

csv = ARG1

eval 'set terminal svg size 900,420 ' . look
set datafile missing NaN
sets = ''
note(set) = sets = strstrt(sets . ' ', ' ' . set . ' ') ? sets : sets . ' ' . set
stats csv using (note(strcol('devices')), column('sensors')) nooutput
set xrange [0 : STATS_max * 1.05]
of(i) = strcol('devices') eq word(sets, i) ? column('sensors') : NaN

set label 1 ARG3
set multiplot layout 1,3 title ARG2
set xlabel 'sensors in a batch'
set yrange [0:*]
unset key
set title 'milliseconds per batch'
plot for [i = 1:words(sets)] csv using (of(i)):(column('ms') / column('batches')) with linespoints linetype 2 * i - 1
unset label 1
set title 'speed-up over the first device'
plot for [i = 1:words(sets)] csv using (of(i)):(column('speed_up')) with linespoints linetype 2 * i - 1
set title 'efficiency, %'
set key inside bottom right title 'devices'
plot for [i = 1:words(sets)] csv using (of(i)):(100 * column('efficiency')) with linespoints linetype 2 * i - 1 \
       title word(sets, i)
