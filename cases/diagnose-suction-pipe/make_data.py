#!/usr/bin/env python3
"""Writes data.csv from the printed means and standard deviations of Jensen (2018), Tables A.1 and A.3."""
import statistics
import sys
import tomllib

# Of the printed number of rags so many count as independent: the same 20 rags were passed again and again (the printed ANOVA follows from
# shares of 0.28 to 0.60 of them).
INDEPENDENT = 0.5
NORMAL = statistics.NormalDist()


def sample(mean, sigma, n):
    """n numbers with exactly this mean and standard deviation, spread as those of a normal distribution."""
    quantiles = [NORMAL.inv_cdf((i + 0.5) / n) for i in range(n)]
    scale = sigma / statistics.stdev(quantiles)
    return [mean + scale * q for q in quantiles]


def main(source):
    with open(source, "rb") as file:
        points = tomllib.load(file)["point"]
    print("# Printed moments as samples: see make_data.py.")
    print("point,replicate,t_s,observable,value")
    for number, point in enumerate(points, 1):
        print(f"{number},1,,vx,{point['textile_velocity_m_s']}")
        for name, key in (("area", "area_m2"), ("elongation_ratio", "elongation_ratio"), ("orientation", "orientation_deg"), ("y", "y_mm")):
            n = round(INDEPENDENT * point["rags"])
            for replicate, value in enumerate(sample(point[key]["mean"], point[key]["sigma"], n), 1):
                print(f"{number},{replicate},,{name},{value:.6g}")


if __name__ == "__main__":
    main(sys.argv[1])
