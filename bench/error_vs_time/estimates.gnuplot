# gnuplot -c estimates.gnuplot ESTIMATES.dat PLOT.png "NAME NAME...": estimated against true error, a scene each block. The names are one
# argument: gnuplot passes nine at most.
set terminal pngcairo noenhanced size 820,720 font "sans,12"
set output ARG2
set logscale xy
set size ratio -1
set grid lt 1 lw 0.8 lc rgb "#dcdcdc"
set title "Estimated against true error: a point each solve"
set xlabel "true nRMSE, %"
set ylabel "estimated nRMSE, %"
set tics (0.2, 0.5, 1, 2, 5, 10, 20)
set xrange [0.3:20]
set yrange [0.3:20]
set key bottom right
array colours[6] = ["#c0392b", "#2c5f8a", "#3a9d5d", "#d68910", "#8e44ad", "#222222"]
plot x with lines lc rgb "#555555" title "right", \
     2 * x with lines dt 2 lc rgb "#999999" title "a factor of two", x / 2 with lines dt 2 lc rgb "#999999" notitle, \
     for [n = 1:words(ARG3)] ARG1 index n - 1 using ($1*100):($2*100) with points pt (n > 6 ? 9 : 7) ps 1.1 \
       lc rgb colours[(n - 1) % 6 + 1] title word(ARG3, n)
